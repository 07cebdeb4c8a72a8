"""A prompt box: a sentence, how long, which seed; below it four motions that do what it says.

Type and press Enter, or press the button. A message says what cannot be acted, and the motions
before it stay.
Source: MoFusion Fig. 6.  Notebook: 16
"""

import html

import ipywidgets

from ..conditions.text import TextError
from ..performers.mover import LONGEST, SECONDS, SHORTEST, Mover
from .live import TURN
from .player import Player
from .still import stills, with_still

ANSWERS = 4
SENTENCE = "walks forward, then waves with the left hand"
SEEDS = 10_000


class Prompt(ipywidgets.VBox):
    """A box for sentences, and a player with `ANSWERS` motions of a mover for the last one.

    `motions` are those on show. `act()` does what the button does.
    Raises TextError and ValueError as `Mover.act`, for the first sentence; ValueError for a seed
    that the box cannot show.
    """

    def __init__(self, mover: Mover, text: str = SENTENCE, seconds: float = SECONDS, seed: int = 0):
        _check_sizes(seconds, seed)  # a slider and a box would put them right silently
        self.mover = mover
        self.motions: list = []
        self._answered = ("", 0.0, 0)  # the sentence, seconds and seed of the motions on show
        self._note = ""  # what was said of the answered sentence
        wide = ipywidgets.Layout(width="98%")
        self.text = ipywidgets.Text(
            text, description="sentence", continuous_update=False, layout=wide
        )
        self.seconds = ipywidgets.FloatSlider(
            seconds, min=SHORTEST, max=LONGEST, step=0.5, description="seconds",
            continuous_update=False,
        )  # fmt: skip
        self.seed = ipywidgets.BoundedIntText(seed, min=0, max=SEEDS, description="seed")
        self.button = ipywidgets.Button(
            description="Act", tooltip="make four motions of this sentence", button_style="primary"
        )
        self.message = ipywidgets.HTML()
        self.player = None
        self._answer()
        self.player = Player([one.positions for one in self.motions], labels=self._labels())
        for control in (self.text, self.seconds, self.seed):
            control.observe(lambda _: self.act(), names="value")
        self.button.on_click(lambda _: self.act())
        controls = ipywidgets.HBox([self.seconds, self.seed, self.button])
        super().__init__([self.text, controls, self.message, self.player])

    def _repr_mimebundle_(self, **kwargs):
        still = f"<p>{html.escape(self._answered[0])}</p>" + "".join(stills(self))
        return with_still(super()._repr_mimebundle_(**kwargs), {"text/html": still})

    def act(self) -> None:
        """Answer the sentence in the box, unless it is answered already."""
        with TURN:
            self._act()

    def _act(self) -> None:
        if self._asked() == self._answered:
            self._say(self._note)
            return
        self.button.disabled = True
        self._say("moving ...")
        try:
            self._answer()
        except (TextError, ValueError) as error:
            self._say(str(error), "alert")
        except BaseException:
            self._say("stopped by an error; the motions are those of before", "alert")
            raise
        else:
            self.player.show([one.positions for one in self.motions], labels=self._labels())
        finally:
            self.button.disabled = False

    def _asked(self) -> tuple[str, float, int]:
        return self.text.value.strip(), self.seconds.value, self.seed.value

    def _answer(self) -> None:
        text, seconds, seed = asked = self._asked()
        found = self.mover.reader.read(text)
        self.motions = self.mover.act(  # type: ignore[assignment]  # several: a list
            found, seconds=seconds, samples=ANSWERS, seed=seed, progress=False
        )
        self._answered = asked
        notes = [*found.notes]
        for label, motion in zip(self._labels(), self.motions, strict=True):
            notes += [f"{label}: {note}" for note in motion.notes[len(found.notes) :]]
        self._note = "; ".join(notes)
        self._say(self._note)

    def _labels(self) -> list[str]:
        return [f"answer {k + 1}" for k in range(len(self.motions))]

    def _say(self, words: str, role: str = "status") -> None:
        """Show plain text below the box; a screen reader reads it."""
        self.message.value = f'<div role="{role}">{html.escape(words)}</div>'


def _check_sizes(seconds: float, seed: int) -> None:
    if not SHORTEST <= seconds <= LONGEST:
        raise ValueError(f"seconds must be {SHORTEST:g} to {LONGEST:g}, not {seconds}")
    if not 0 <= seed <= SEEDS:
        raise ValueError(f"seed must be 0 to {SEEDS:,} in a prompt box, not {seed}")
