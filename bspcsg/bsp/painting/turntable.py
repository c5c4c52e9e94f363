"""Write a sequence of pictures as an animated GIF."""

import io
from collections.abc import Iterable

from .picture import Picture
from .png import image

#: The shortest time for which browsers show a frame, in milliseconds.
_MIN_FRAME_MILLISECONDS = 20


def gif(pictures: Iterable[Picture], seconds: float) -> bytes:
    """Return the pictures as the bytes of an animated GIF file that repeats endlessly.

    Parameters
    ----------
    pictures : iterable of Picture
        Pictures of equal width and height.
    seconds : float
        The duration of one round of all pictures.

    Raises
    ------
    BspcsgError
        If Pillow is not installed; code "missing_dependency".
    """
    frames = [image(one.painting, one.background, one.line_width, one.samples) for one in pictures]
    from PIL import Image

    palette = frames[0].convert("RGB").quantize(255)
    # With a palette for each picture, the GIF would be larger and flicker.
    flat = [
        frame.convert("RGB").quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames
    ]
    buffer = io.BytesIO()
    flat[0].save(
        buffer,
        "GIF",
        save_all=True,
        append_images=flat[1:],
        duration=max(_MIN_FRAME_MILLISECONDS, round(1000 * seconds / len(flat))),
        loop=0,
        optimize=False,
    )
    return buffer.getvalue()
