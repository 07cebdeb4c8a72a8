"""The goals of the measures, by the names of their records."""

from dataclasses import dataclass

from .markdown import number


@dataclass(frozen=True)
class Bar:
    """A measure and the range it should lie in; an open side is None."""

    name: str
    at_least: float | None = None
    at_most: float | None = None

    @property
    def text(self) -> str:
        if None not in (self.at_least, self.at_most):
            return f"{self.at_least:g} to {self.at_most:g}"
        return (
            f"at least {self.at_least:g}" if self.at_most is None else f"at most {self.at_most:g}"
        )

    def met(self, value: float) -> bool:
        return (self.at_least is None or value >= self.at_least) and (
            self.at_most is None or value <= self.at_most
        )

    def shown(self, value: float) -> str:
        """Three digits, or as many as show on which side of the goal the value lies."""
        texts = (number(value), *(f"{value:.{digits}g}" for digits in range(4, 18)))
        return next(text for text in texts if self.met(float(text)) == self.met(value))


BARS = (
    Bar("walker.bone_rmse_cm", at_most=0.3),
    Bar("walker.adherence_excess_mps", at_most=0.03),
    Bar("walker.adherence_shuffled_over_own", at_least=5),
    Bar("walker.drift_ratio", at_most=1.2),
    Bar("walker.skating_over_data", at_most=1.5),
    Bar("walker.diversity_over_data", at_least=0.5, at_most=1.5),
    Bar("bench.modiff_frame_paper_x", at_least=5),
    Bar("bench.modiff_frame_small_x", at_least=3.3),
    Bar("bench.sampler_over_diffusers", at_most=0.2),
    Bar("bench.sampler_over_smalldiffusion", at_most=0.75),
    Bar("bench.walker_80s_bone_rmse_cm", at_most=0.5),
    Bar("bench.walker_80s_adherence_excess_mps", at_most=0.04),
    Bar("bench.import_over_torch", at_most=1.1),
    Bar("bench.front_door_over_torch", at_most=1.1),
    Bar("dancer.bas_share", at_least=0.75),
    Bar("dancer.speed_over_data", at_least=0.9, at_most=1.1),
    Bar("dancer.beats_per_beat_over_data", at_least=0.8, at_most=1.25),
    Bar("dancer.bone_rmse_cm", at_most=1.0),
    Bar("dancer.bone_gain", at_least=0.25),
    Bar("dancer.multimodality_over_data", at_least=0.75, at_most=1.25),
    Bar("regression.multimodality", at_most=0.001),
    Bar("dancer.long200_over_100", at_least=0.7),
    Bar("dancer.long400_over_100", at_least=0.7),
    Bar("dancer.turning_over_data", at_least=0.7, at_most=1.3),
    Bar("dancer.travel_over_data", at_least=0.7, at_most=1.3),
    Bar("dancer.standing_feet_over_data", at_least=0.7, at_most=1.3),
    Bar("dancer.genre_accuracy_over_data", at_least=0.8),
    Bar("dancer.unheard_tempo_worst_share", at_least=0.5),
    Bar("dance_data.standing_feet", at_most=0.4),
    Bar("dance_data.turn_8s_deg", at_least=120),
    Bar("player.audio_offset_ms", at_most=50),
    Bar("bench.unet_sampling_n64_x", at_least=1.4),
    Bar("bench.unet_sampling_n200_x", at_least=1.15),
    Bar("bench.unet_training_x", at_least=0.85),
    Bar("bench.unet_sampling_diffusers_x", at_least=1.15),
    Bar("bench.logmel_ms_per_minute", at_most=10),
    Bar("bench.logmel_x", at_least=1.7),
    Bar("mend.dropout_gain_bone_cm", at_least=0),
    Bar("mend.dropout_gain_adherence_mps", at_least=0),
    Bar("mend.dropout_cost_complete", at_most=1.1),
    Bar("mend.arm_rmse_over_ridge", at_most=1),
    Bar("mend.arm_rmse_over_meanpose", at_most=1),
    Bar("mend.frames_rmse_over_interpolation", at_most=1),
    Bar("mend.table2_ratio", at_most=1.5),
    Bar("mend.table2_walker_ge_over_whole", at_most=1.2),
    Bar("mend.table2_walker_bone_re_cm", at_most=0.4),
    Bar("mend.footsteps_walker_over_data", at_least=0.95, at_most=1.05),
    Bar("mend.footsteps_over_data", at_least=0.95, at_most=1.05),
    Bar("inbetween.keyframe_error_cm", at_most=0),
    Bar("inbetween.gap15_error_over_interpolation", at_most=1),
    Bar("inbetween.gap30_error_over_interpolation", at_most=1),
    Bar("inbetween.gap60_error_over_interpolation", at_most=1),
    Bar("inbetween.npss_over_interpolation", at_most=1),
    Bar("inbetween.seam_jump_over_data", at_most=1.5),
    Bar("words.action_accuracy", at_least=0.9),
    Bar("words.side_accuracy", at_least=0.95),
    Bar("words.count_accuracy", at_least=0.7),
    Bar("words.order_accuracy", at_least=0.9),
    Bar("words.minimal_pair", at_least=0.8),
    Bar("words.heldout_minimal_pair", at_least=0.75),
    Bar("words.r_precision_top3_over_real", at_least=0.85),
    Bar("words.heldout_action_accuracy", at_least=0.75),
    Bar("words.heldout_r_precision_top3_over_real", at_least=0.6),
    Bar("words.wording_action_accuracy", at_least=0.6),
    Bar("words.bone_rmse_cm", at_most=1.0),
    Bar("words.skating_over_data", at_most=2),
    Bar("words.multimodality_over_data", at_least=0.6, at_most=1.3),
    Bar("words.speed_over_data", at_least=0.85, at_most=1.15),
    Bar("words.nearest_training_over_data", at_least=0.8),
    Bar("words.looked_kappa", at_least=0.8),
    Bar("words.edit_changes", at_least=0.8),
    Bar("words.edit_keeps_over_resampled", at_most=0.5),
    Bar("bench.mover_seconds", at_most=8),
    Bar("real.seam_over_motion", at_most=1.3),
    Bar("real.seam_p95_over_motion", at_most=1.5),
    Bar("real.continuation_bone_cm", at_most=0.3),
    Bar("real.continuation_skating_mps", at_most=0.05),
    Bar("real.continuation_adherence_mps", at_most=0.03),
    Bar("real.continuation_floor_cm", at_most=2),
    Bar("real.continuation_diversity_over_synthetic", at_least=0.7),
    Bar("real.style_kept", at_least=0.7),
    Bar("real.inbetween_over_interpolation", at_most=0.85),
    Bar("real.inbetween_walks_over_interpolation", at_most=0.65),
    Bar("real.inbetween_others_over_interpolation", at_most=1),
    Bar("real.inbetween_one_over_interpolation", at_most=1),
    Bar("real.inbetween_one_p90_over_interpolation", at_most=1.3),
    Bar("real.inbetween_energy_over_interpolation", at_most=0.6),
    Bar("real.inbetween_others_energy_over_interpolation", at_most=0.75),
    Bar("real.inbetween_skating_over_source", at_most=1.5),
    Bar("real.inbetween_skating_p90_over_source", at_most=2.5),
    Bar("real.inbetween_fastest_over_source", at_most=1.5),
    Bar("real.inbetween_fallback_share", at_most=0.1),
    Bar("course.mutants_passing", at_most=0),
    Bar("course.zoo_caught", at_least=1),
    Bar("course.wrong_diagnosis", at_most=0.02),
    Bar("course.right_answers_rejected", at_most=0),
    Bar("course.words_max", at_most=1800),
    Bar("course.ideas_max", at_most=3),
    Bar("course.prose_numbers_unbacked", at_most=0),
    Bar("course.pages_raw_formulas", at_most=0),
    Bar("course.pages_raw_widgets", at_most=0),
    Bar("course.demo_first_motion_s", at_most=10),
)
