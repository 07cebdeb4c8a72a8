"""Words for the keys of the records, for the tables and the opening of docs/RESULTS.md."""

import re

# For measures with a goal: the subject of a sentence "... is 0.22 cm".
GOALS = {
    "walker.bone_rmse_cm": "the walker's bone error",
    "walker.adherence_excess_mps": "the walker's control error beyond that of the data",
    "walker.adherence_shuffled_over_own": (
        "the walker's error on other clips' controls, over that on its own"
    ),
    "walker.drift_ratio": (
        "the walker's bone or control error, whichever grows more, in the last 3 s, over that "
        "in the first 3 s"
    ),
    "walker.skating_over_data": (
        "the sliding of the walker's planted feet, over the data's or 0.02 m/s if that is larger"
    ),
    "walker.diversity_over_data": "the diversity of the walker's walks, over that of the data",
    "bench.modiff_frame_paper_x": (
        "the speed of a frame at the paper's size, over a plain loop with diffusers"
    ),
    "bench.modiff_frame_small_x": (
        "the speed of a frame at the shipped size, over a plain loop with diffusers"
    ),
    "bench.sampler_over_diffusers": "the cost of the sampler itself, over that of diffusers",
    "bench.sampler_over_smalldiffusion": (
        "the cost of the sampler itself, over that of smalldiffusion"
    ),
    "bench.walker_80s_bone_rmse_cm": "the bone error of walks of 80 s",
    "bench.walker_80s_adherence_excess_mps": (
        "the control error of walks of 80 s beyond that of the data"
    ),
    "bench.import_over_torch": "the time to import the library, over that to import torch",
    "bench.front_door_over_torch": (
        "the time until `md.read_motion` and `md.load` can be called, over that to import torch"
    ),
    "dancer.bas_share": "the beat alignment of the dances beyond chance, over that of the data",
    "dancer.speed_over_data": "the speed of the dances, over that of the data",
    "dancer.beats_per_beat_over_data": "the number of stops for each beat, over that of the data",
    "dancer.bone_rmse_cm": "the dancer's bone error",
    "dancer.bone_gain": "the share of the bone error that kinematic losses remove",
    "dancer.multimodality_over_data": "the variety of dances to one song, over that of the data",
    "regression.multimodality": "the variety of the regression's dances to one song",
    "dancer.long200_over_100": "the beat alignment of dances of 10 s, over that of 5 s",
    "dancer.long400_over_100": "the beat alignment of dances of 20 s, over that of 5 s",
    "dancer.turning_over_data": "the angle that the dances turn within 8 s, over that of the data",
    "dancer.travel_over_data": "the speed at which the dances travel, over that of the data",
    "dancer.standing_feet_over_data": (
        "the share of frames in which a dancing foot stands, over that of the data"
    ),
    "dancer.genre_accuracy_over_data": (
        "how often a classifier recognises the genre of a dance, over that of the data's dances"
    ),
    "dancer.unheard_tempo_worst_share": (
        "the beat alignment at tempi kept out of training beyond chance, over that of the data "
        "(the worse of two ranges)"
    ),
    "dance_data.standing_feet": (
        "the share of frames in which a foot of the data's dances stands (mean over genres)"
    ),
    "dance_data.turn_8s_deg": (
        "the degrees that the data's dances turn within 8 s (mean over genres)"
    ),
    "player.audio_offset_ms": "the player's offset between sound and picture (95th percentile)",
    "bench.unet_sampling_n64_x": "the U-Net's speed of sampling 64 frames, over lucidrains' Unet1D",
    "bench.unet_sampling_n200_x": (
        "the U-Net's speed of sampling 200 frames, over lucidrains' Unet1D"
    ),
    "bench.unet_training_x": "the U-Net's speed of training, over lucidrains' Unet1D",
    "bench.unet_sampling_diffusers_x": "the U-Net's speed of sampling, over diffusers' UNet1DModel",
    "bench.logmel_x": "the speed of the log-Mel spectrogram, over librosa",
    "bench.logmel_ms_per_minute": "the time for the log-Mel spectrogram of a minute of sound",
    "mend.dropout_gain_bone_cm": "what diffusion dropout saves in bone error, with joints missing",
    "mend.dropout_gain_adherence_mps": (
        "what diffusion dropout saves in control error, with joints missing"
    ),
    "mend.dropout_cost_complete": (
        "the walker's bone or control error, whichever ratio is larger, over that of the walker "
        "without diffusion dropout, from complete pasts"
    ),
    "mend.arm_rmse_over_ridge": "the error of a reconstructed arm, over that of ridge regression",
    "mend.arm_rmse_over_meanpose": "the error of a reconstructed arm, over that of the mean pose",
    "mend.frames_rmse_over_interpolation": (
        "the error of reconstructed frames, over that of straight lines"
    ),
    "mend.table2_ratio": (
        "the small walkers' bone error with joints missing (walks or reconstructed pasts, "
        "whichever is larger), over that without"
    ),
    "mend.footsteps_over_data": (
        "the number of the small walkers' footsteps with joints missing, over that of the data"
    ),
    "mend.table2_walker_ge_over_whole": (
        "the walker's bone error with joints missing, over that without"
    ),
    "mend.table2_walker_bone_re_cm": "the bone error of pasts that the walker reconstructed",
    "mend.footsteps_walker_over_data": (
        "the number of the walker's footsteps with joints missing, over that of the data"
    ),
    "inbetween.keyframe_error_cm": "the error of in-betweens at the given frames",
    "inbetween.gap15_error_over_interpolation": (
        "the error in gaps of 15 frames, over that of straight lines"
    ),
    "inbetween.gap30_error_over_interpolation": (
        "the error in gaps of 30 frames, over that of straight lines"
    ),
    "inbetween.gap60_error_over_interpolation": (
        "the error in gaps of 60 frames, over that of straight lines"
    ),
    "inbetween.npss_over_interpolation": "the spectral error (NPSS), over that of straight lines",
    "inbetween.seam_jump_over_data": "the jump at the ends of a gap, over that of the data",
    "words.action_accuracy": "the share of the acts asked for that the mover's motions show",
    "words.side_accuracy": "the share of the mover's acts on the side asked for",
    "words.count_accuracy": "the share of the mover's acts that happen as often as asked",
    "words.order_accuracy": "the share of the mover's acts in the order asked for",
    "words.minimal_pair": (
        "how often a motion is nearer to its own caption than to one that differs in one thing"
    ),
    "words.heldout_minimal_pair": "the same for combinations that nobody trained for",
    "words.r_precision_top3_over_real": "the mover's R-Precision (top 3), over that of the data",
    "words.heldout_action_accuracy": (
        "the share of acts that are shown, of combinations that nobody trained for"
    ),
    "words.heldout_r_precision_top3_over_real": (
        "the R-Precision (top 3) of such combinations, over that of the data"
    ),
    "words.wording_action_accuracy": "the share of acts that are shown, by verbs never seen",
    "words.bone_rmse_cm": "the mover's bone error",
    "words.skating_over_data": (
        "the sliding of the mover's planted feet, over the data's or 0.02 m/s if that is larger"
    ),
    "words.multimodality_over_data": "the variety of motions to one text, over that of the data",
    "words.speed_over_data": "the speed of the mover's motions, over that of the data",
    "words.nearest_training_over_data": (
        "the distance of the mover's motions to the nearest training motion, over that of the data"
    ),
    "words.looked_kappa": "Cohen's kappa of the recogniser and of eyes, on the mover's motions",
    "words.edit_changes": "how often an edit by words shows what was asked for",
    "words.edit_keeps_over_resampled": (
        "how far legs and path move in an edit by words, over sampling the new sentence alone"
    ),
    "bench.mover_seconds": "the seconds for four answers of 6 s to a sentence",
    "real.seam_over_motion": (
        "the fastest joint where a recording is continued, over the fastest around it (median)"
    ),
    "real.seam_p95_over_motion": (
        "the fastest joint where a recording is continued, over the fastest around it "
        "(95th percentile)"
    ),
    "real.continuation_bone_cm": "the bone error of continuations of recordings",
    "real.continuation_skating_mps": "the sliding of planted feet in continuations of recordings",
    "real.continuation_adherence_mps": "the control error of continuations of recordings",
    "real.inbetween_over_interpolation": (
        "the error of in-betweens of recordings, over that of the better interpolation (the mean "
        "of ten, median)"
    ),
    "real.inbetween_walks_over_interpolation": (
        "the error of in-betweens of recorded walks, over that of the better interpolation"
    ),
    "real.inbetween_others_over_interpolation": (
        "the error of in-betweens of recordings that are no walks, over interpolation's"
    ),
    "real.inbetween_one_over_interpolation": (
        "the error of one in-between of a recording, over that of the better interpolation (median)"
    ),
    "real.inbetween_one_p90_over_interpolation": (
        "the error of one in-between of a recording, over that of the better interpolation (90th "
        "percentile)"
    ),
    "real.inbetween_energy_over_interpolation": (
        "the energy score of ten in-betweens of a recording, over that of the better interpolation"
    ),
    "real.inbetween_others_energy_over_interpolation": (
        "the energy score of in-betweens of recordings that are no walks, over interpolation's"
    ),
    "real.inbetween_skating_over_source": (
        "the sliding of planted feet in in-betweens of recordings, over the recording's (median)"
    ),
    "real.inbetween_skating_p90_over_source": (
        "the sliding of planted feet in in-betweens of recordings, over the recording's (90th "
        "percentile)"
    ),
    "real.inbetween_fastest_over_source": (
        "the fastest joint of in-betweens of recordings, over the recording's (90th percentile)"
    ),
    "real.inbetween_fallback_share": "the share of in-betweens of recordings that are drawn again",
    "real.continuation_floor_cm": (
        "the depth under the floor of continuations of recordings (95th percentile)"
    ),
    "real.continuation_diversity_over_synthetic": (
        "the spread of continuations of recordings, over that of synthetic walks"
    ),
    "real.style_kept": (
        "the share of continuations whose style is nearer to their own past than to another's"
    ),
    "course.mutants_passing": (
        "the number of mechanically changed solutions that a check lets pass"
    ),
    "course.zoo_caught": "the share of the bug zoo's wrong answers that the checks refuse",
    "course.wrong_diagnosis": (
        "the share of hints that name another mistake than the one that was made"
    ),
    "course.right_answers_rejected": "the number of unusual right answers that a check refuses",
    "course.words_max": "the most words in the text of a notebook, without what is extra",
    "course.ideas_max": "the most new ideas that a notebook names",
    "course.prose_numbers_unbacked": (
        "the number of figures in answers that no cell before them has printed"
    ),
    "course.pages_raw_formulas": "the number of formulas on the pages that are seen as TeX",
    "course.pages_raw_widgets": "the number of widgets on the pages that are seen as Python text",
    "course.demo_first_motion_s": (
        "the time from opening a demo's page to its first moving figure (slowest of four)"
    ),
}

# For columns and rows: the last part of a key.
KINDS = {
    "bone_rmse_cm": "bone error",
    "bone_rmse_within_clip_cm": "bone error around each clip's own lengths",
    "bone_rmse_data_cm": "bone error of the data",
    "adherence_mps": "control error",
    "adherence_data_mps": "control error of the data",
    "adherence_excess_mps": "control error beyond the data's",
    "adherence_shuffled_over_own": "error on other controls over that on its own",
    "drift_bone_ratio": "bone error, last 3 s over first 3 s",
    "drift_adherence_ratio": "control error, last 3 s over first 3 s",
    "drift_ratio": "drift: the larger of both",
    "skating_mps": "sliding of planted feet",
    "skating_data_mps": "sliding of planted feet, data",
    "skating_over_data": "sliding over the data's, or over 0.02 m/s if that is larger",
    "planted_share": "share of frames with a planted foot",
    "planted_share_data": "share of frames with a planted foot, data",
    "diversity_m": "diversity",
    "diversity_data_m": "diversity of the data",
    "diversity_over_data": "diversity over the data's",
    "diversity_over_data_median": "diversity over the data's, median past",
    "steps": "training steps",
    "bas": "beat alignment over the dance's stops",
    "bas_music": "beat alignment over the music's beats",
    "bas_share": "share of the data's alignment",
    "speed_over_data": "speed over the data's",
    "beats_per_beat_over_data": "stops for each beat, over the data's",
    "multimodality_over_data": "variety for one song, over the data's",
    "fid": "Fréchet distance (FID)",
    "speed_mps": "speed",
    "standing_feet": "share of frames in which a foot stands",
    "turn_8s_deg": "degrees turned within 8 s",
    "travel_mps": "speed of travel",
    "beats_f": "beats heard (F-measure)",
    "tracker_f": "beats that the tracker finds",
    "beats_f_over_tracker": "the ear over the tracker",
    "downbeats_f": "first beats of bars heard",
    "genre_accuracy": "genre told rightly",
    "r_precision_top1": "R-Precision, top 1",
    "r_precision_top2": "R-Precision, top 2",
    "r_precision_top3": "R-Precision, top 3",
    "r_precision_top3_over_real": "R-Precision (top 3) over the data's",
    "mm_dist": "distance of text and motion (MM-Dist)",
    "mm_dist_over_real": "the same, over the data's",
    "diversity": "difference of motions (Diversity)",
    "multimodality": "difference of motions to one text (MultiModality)",
    "action_accuracy": "acts shown",
    "side_accuracy": "of these, on the side asked for",
    "count_accuracy": "as often as asked for",
    "order_accuracy": "in the order asked for",
    "direction_accuracy": "in the direction asked for",
    "whole_accuracy": "clips with everything right",
    "minimal_pair": "nearer to its own of two captions",
    "minimal_pair.order": "the same, captions that differ in order",
    "understood": "captions that can be read",
    "nearest_training_over_data": "distance to the nearest training motion, over the data's",
    "changes": "the new act is shown",
    "keeps_m": "legs and path moved by",
    "keeps_over_resampled": "the same, over plain sampling",
    "parameters": "parameters",
    "step_ms": "a training step, ms",
    "step_over_x0": "a training step, over x0's",
    "pass_ms": "one pass, ms",
    "pass_over_x0": "one pass, over x0's",
    "dance_ms": "8 dances, ms",
    "dance_over_x0": "8 dances, over x0's",
    "beat_mass": "attention near beats",
    "beat_mass_over_shuffled": "over that near other songs' beats",
    "beat_mass_over_shifted": "over that near its beats, shifted",
    "seconds_read": "music read by a frame",
    "dropout_gain_bone_cm": "saved in bone error, with joints missing",
    "dropout_gain_adherence_mps": "saved in control error, with joints missing",
    "walker_dropout_gain_bone_cm": "walker: saved in bone error, with joints missing",
    "walker_dropout_gain_adherence_mps": "walker: saved in control error, with joints missing",
    "pairs_dropout_cost_complete": "small: error over that without dropout, complete pasts",
    "dropout_cost_complete": "error over that without dropout, complete pasts",
    "rmse_cm": "mean of ten",
    "one_rmse_cm": "one",
    "paper_rmse_cm": "as in the paper, mean",
    "paper_one_rmse_cm": "as in the paper, one",
    "rmse_ridge_cm": "ridge regression",
    "rmse_meanpose_cm": "mean pose",
    "rmse_over_ridge": "over ridge regression",
    "nearer_than_ridge": "share nearer than ridge regression",
    "rmse_over_meanpose": "over the mean pose",
    "nearer_than_meanpose": "share nearer than the mean pose",
    "rmse_interpolation_cm": "straight lines",
    "rmse_over_interpolation": "over straight lines",
    "nearer_than_interpolation": "share nearer than straight lines",
    "there_and_back": "MoDiff's, there and back",
    "there_and_back_masked": "the same, with known entries held on the way back",
    "masked": "MoFusion's, under a mask",
    "masked_blended": "the same, blended and guided",
    "exact": "draws from the true conditional",
    "npss_over_interpolation": "NPSS over straight lines'",
    "npss_velocity_over_interpolation": "NPSS of velocities over straight lines'",
    "seam_jump_over_data": "jump at the seam over the data's",
    "seam_jump_lines_over_data": "jump of straight lines",
    "seam_jump_masked_over_data": "jump, masked as in the paper",
    "skating_lines_mps": "sliding of straight lines",
    "skating_masked_mps": "sliding, masked as in the paper",
}
TABLE_2 = {
    "bone_whole_cm": "bone error, complete pasts",
    "bone_ge_cm": "bone error of walks from broken pasts",
    "bone_re_cm": "bone error of reconstructed pasts, as the network gives them",
    "bone_re_bones_cm": "the same with bones kept, our way",
    "bone_re_paper_cm": "bone error of reconstructed pasts, the paper's way",
    "ratio": "the larger of walks and reconstructions, over complete pasts",
    "ge_over_whole": "walks from broken pasts over complete pasts",
}
WALKERS = {"": "small walkers", "keep5_": "small walkers, five poses kept", "walker_": "`walker`"}
FOOTSTEPS = {
    "": "footsteps over the data's, robust count",
    "_paper": "footsteps over the data's, the paper's count",
}


def in_words(key: str) -> str | None:
    """The words of a key; None if it has none yet."""
    second = re.fullmatch(r"mend\.table2_(keep5_|walker_|)(\w+)", key)
    if second and second[2] in TABLE_2:
        return f"{WALKERS[second[1]]}: {TABLE_2[second[2]]}"
    steps = re.fullmatch(r"mend\.footsteps_(keep5_|walker_|)over_data(_paper|)", key)
    if steps:
        return f"{WALKERS[steps[1]]}: {FOOTSTEPS[steps[2]]}"
    return way_in_words(key) or KINDS.get(key)


def way_in_words(key: str) -> str | None:
    """The words of a method such as `masked.50.x5`: the number of steps, and what was added."""
    way = re.fullmatch(
        r"(masked|there-and-back|gibbs)\.(\d+)(?:\.(?:x(\d+)|(blended|guided)[\d.]+))?", key
    )
    if way is None:
        return None
    kind, steps, times, more = way.groups()
    if kind == "masked":
        added = f", each {times} times" if times else f", {more}" if more else ""
        return f"under a mask, {steps} steps{added}"
    rounds = "once" if steps == "1" else f"{steps} times"
    held = ", with known entries seen on the way back" if kind == "gibbs" else ""
    return f"there and back, {rounds}{held}"


def label(cell: str) -> str:
    """Add the words before a cell that is only a key; any other cell stays as it is."""
    key = re.fullmatch(r"`([^`]+)`", cell)
    words = in_words(key[1]) if key else None
    return f"{words}<br>{cell}" if words else cell
