"""What stands for a widget where no kernel runs: on GitHub, in exported pages, in print.

`Beside` is a row of widgets. Without a kernel, those show themselves that can.
"""

import base64
import html

import ipywidgets
from PIL.Image import Image

from . import poster

STACK = """<div style="position:relative;width:100%;max-width:1200px;min-height:{height}px">
<img alt="{alt}" src="data:image/png;base64,{png}" style="width:100%">
<iframe title="{title}" sandbox="allow-scripts" loading="lazy" srcdoc="{page}"
 style="position:absolute;inset:0;width:100%;height:100%;border:0"></iframe></div>"""

NARROWEST = "1 1 440px"  # equal shares of a row, from so many pixels on
MimeBundle = dict | tuple[dict, dict] | None  # what a widget's `_repr_mimebundle_` returns


def bundle_and_metadata(live: MimeBundle) -> tuple[dict, dict]:
    """A widget's MIME bundle and its metadata, whichever of them it gave."""
    return live if isinstance(live, tuple) else (live or {}, {})


def with_still(live: MimeBundle, still: dict[str, str]) -> tuple[dict, dict]:
    """The live widget, and MIME types that stand for it where it does not run."""
    bundle, metadata = bundle_and_metadata(live)
    return bundle | still, metadata


def page_on_picture(
    page: str, picture: Image, description: str, title: str, height: int
) -> dict[str, str]:
    """A page that runs without a kernel, on a picture for places where nothing runs.

    `height`: pixels; `description` is the picture's alternative text.
    """
    png = base64.b64encode(poster.as_png(picture)).decode()
    stack = STACK.format(
        height=height,
        alt=html.escape(description, quote=True),
        png=png,
        title=title,
        page=html.escape(page, quote=True),
    )
    return {"text/html": stack, "image/png": png, "text/plain": description}


class Beside(ipywidgets.HBox):
    """A row of widgets; what has no room goes on in the next row.  Notebook: 00"""

    def __init__(self, *widgets: ipywidgets.Widget):
        super().__init__(list(widgets))
        self.layout.flex_flow = "row wrap"
        self.layout.align_items = "flex-start"
        for widget in widgets:
            widget.layout.flex = NARROWEST

    def _repr_mimebundle_(self, **kwargs):
        parts = "".join(f"<div>{part}</div>" for part in stills(self))
        still = {"text/html": parts} if parts else {}
        return with_still(super()._repr_mimebundle_(**kwargs), still)


def stills(box: ipywidgets.Box) -> list[str]:
    """The HTML of all widgets in a box, and in the boxes in it, that have any."""
    found = []
    for child in box.children:
        bundle, _ = bundle_and_metadata(child._repr_mimebundle_())
        if "text/html" in bundle:
            found.append(bundle["text/html"])
        elif isinstance(child, ipywidgets.Box):
            found += stills(child)
    return found
