"""What stands for a widget where no kernel runs: on GitHub, in exported pages, in print."""

import base64
import html

from PIL.Image import Image

from . import poster

STACK = """<div style="position:relative;width:100%;max-width:1200px;min-height:{height}px">
<img alt="{alt}" src="data:image/png;base64,{png}" style="width:100%">
<iframe title="{title}" sandbox="allow-scripts" loading="lazy" srcdoc="{page}"
 style="position:absolute;inset:0;width:100%;height:100%;border:0"></iframe></div>"""

MimeBundle = dict | tuple[dict, dict] | None  # what a widget's `_repr_mimebundle_` returns


def split(live: MimeBundle) -> tuple[dict, dict]:
    """A widget's MIME bundle and its metadata, whichever of them it gave."""
    return live if isinstance(live, tuple) else (live or {}, {})


def with_still(live: MimeBundle, still: dict[str, str]) -> tuple[dict, dict]:
    """The live widget, and MIME types that stand for it where it does not run."""
    bundle, metadata = split(live)
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
