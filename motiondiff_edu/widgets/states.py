"""A few states of a figure with sliders, for a page that has no kernel.

They are drawn only when pages are made (`make pages` sets MOTIONDIFF_PAGES): each costs a drawing.
"""

import html
import itertools
import os
import uuid
from collections.abc import Callable, Mapping, Sequence

MOST = 16  # pictures of one figure that a page carries

STATES = """<div class="states" id="{name}">
<p>{choices} <span class="kernel-note">(A few states; the notebook has all.)</span></p>
{pictures}
<script>
(() => {{
  const box = document.getElementById("{name}");
  const show = () => {{
    const wanted = [...box.querySelectorAll("select")].map((one) => one.value).join(" ");
    for (const state of box.querySelectorAll("[data-state]")) {{
      state.hidden = state.dataset.state !== wanted;
    }}
  }};
  box.addEventListener("change", show);
  show();
}})();
</script>
</div>"""


def making_pages() -> bool:
    """Whether this run is for web pages (`make pages` sets MOTIONDIFF_PAGES)."""
    return os.environ.get("MOTIONDIFF_PAGES", "") not in ("", "0")


def few(choices: Mapping[str, Sequence], start: Mapping) -> dict[str, list]:
    """At most MOST combinations: of each long list some values, the one at the start among them."""
    kept = {name: list(values) for name, values in choices.items()}
    while _count(kept) > MOST:
        longest = max(kept, key=lambda name: len(kept[name]))
        kept[longest] = _thinned(kept[longest], start[longest], len(kept[longest]) - 1)
    return kept


def _count(kept: Mapping[str, Sequence]) -> int:
    count = 1
    for values in kept.values():
        count *= len(values)
    return count


def _thinned(values: list, keep, n: int) -> list:
    """n of the values, evenly spread, `keep` among them in the nearest one's place."""
    n = max(n, 1)
    places = [round(i * (len(values) - 1) / max(n - 1, 1)) for i in range(n)]
    wanted = values.index(keep)
    nearest = min(range(n), key=lambda i: abs(places[i] - wanted))
    places[nearest] = wanted
    return [values[i] for i in sorted(set(places))]


def as_page(draw: Callable[[dict], str], choices: Mapping[str, Sequence], start: Mapping) -> str:
    """HTML with a picture for each combination of a few values, and a menu for each argument.

    `draw(values)` gives a picture's HTML. `choices`: all values of each argument, in order.
    """
    kept = few(choices, start)
    menus = " ".join(
        f"<label>{html.escape(name)} <select>{_options(values, start[name])}</select></label>"
        for name, values in kept.items()
    )
    pictures = []
    for at in itertools.product(*[range(len(values)) for values in kept.values()]):
        values = {name: kept[name][i] for name, i in zip(kept, at, strict=True)}
        hidden = "" if values == dict(start) else " hidden"
        state = " ".join(map(str, at))
        pictures.append(f'<div data-state="{state}"{hidden}>{draw(values)}</div>')
    name = f"states-{uuid.uuid4().hex[:12]}"
    return STATES.format(name=name, choices=menus, pictures="\n".join(pictures))


def _options(values: Sequence, chosen) -> str:
    return "".join(
        f'<option value="{i}"{" selected" if value == chosen else ""}>{html.escape(_said(value))}'
        "</option>"
        for i, value in enumerate(values)
    )


def _said(value) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)
