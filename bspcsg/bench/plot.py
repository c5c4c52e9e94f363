"""Time against size, as an SVG drawing with logarithmic axes."""
from typing import Any
def plot(record: dict[str, Any]) -> str:
    return ""
