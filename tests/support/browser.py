"""A headless browser, and what its pages do: their texts, pictures, errors and requests."""

import io
import json
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

_NO_WEBGL = ("--disable-gpu", "--disable-3d-apis")

#: Debian's names, and where other systems have them.
_BROWSERS = ("chromium", "chromium-browser", "google-chrome")


@contextmanager
def started(*, webgl: bool) -> Iterator["Browser"]:
    """Yield Chromium, started headless; skip the test if it is not installed."""
    program = next(filter(None, map(shutil.which, _BROWSERS)), None)
    driver = shutil.which("chromedriver")
    if program is None or driver is None:
        pytest.skip("chromium and chromedriver are not installed")
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = program
    window = ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars")
    drawing = ("--enable-unsafe-swiftshader",) if webgl else _NO_WEBGL
    for argument in (*window, *drawing, "--window-size=640,640", "--force-device-scale-factor=1"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    running = webdriver.Chrome(options=options, service=Service(driver))
    try:
        yield Browser(running)
    finally:
        running.quit()


class Browser:
    """A headless browser with one page at a time."""

    def __init__(self, running: Any) -> None:
        self._running = running

    def open(self, path: Path) -> None:
        """Open a file, and clear the logs of earlier pages."""
        self._running.get_log("browser")
        self._running.get_log("performance")
        self._running.get(path.as_uri())

    def size(self, width: int, height: int) -> None:
        """Show pages in a window of a mobile device, `width` × `height` pixels."""
        device = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": True}
        self._running.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", device)

    def device(self, looks: dict[str, Any] | None) -> None:
        """Show pages as a device with these metrics does; None restores the desktop."""
        order = "clearDeviceMetricsOverride" if looks is None else "setDeviceMetricsOverride"
        self._running.execute_cdp_cmd(f"Emulation.{order}", looks or {})

    def run(self, script: str, *arguments: Any) -> Any:
        """Run the body of a JavaScript function in the page, and return its result."""
        return self._running.execute_script(script, *arguments)

    def texts(self, selector: str) -> list[str]:
        """Return the texts of all visible elements that match a selector."""
        script = (
            "return [...document.querySelectorAll(arguments[0])]"
            ".filter(e => e.checkVisibility()).map(e => e.textContent.trim())"
        )
        return list(self.run(script, selector))

    def click(self, selector: str, number: int = 0) -> None:
        """Click the element with this index among the elements that match a selector."""
        element = self._running.find_elements("css selector", selector)[number]
        self.run("arguments[0].scrollIntoView({block: 'center'})", element)
        element.click()

    def type(self, selector: str, *keys: str) -> None:
        """Send keys to the element that matches a selector."""
        self._running.find_element("css selector", selector).send_keys(*keys)

    def choose(self, label: str, value: str) -> None:
        """Choose the option with a value in the select element with a label."""
        self.run(
            "const e = document.querySelector(`select[aria-label='${arguments[0]}']`);"
            "e.value = arguments[1]; e.dispatchEvent(new Event('change'))",
            label,
            value,
        )

    def slide(self, label: str, value: float) -> None:
        """Move the slider with a label to a value."""
        self.run(
            "const e = [...document.querySelectorAll('label')].find("
            "l => l.firstChild.textContent === arguments[0]).querySelector('input');"
            "e.value = arguments[1]; e.dispatchEvent(new Event('input'))",
            label,
            value,
        )

    def press_button(self, text: str) -> None:
        """Click the button with a text."""
        self.run(
            "[...document.querySelectorAll('button')].find("
            "e => e.textContent.trim() === arguments[0]).click()",
            text,
        )

    def press(self, selector: str, x: float, y: float) -> None:
        """Press and release the mouse at the position (x, y) in an element."""
        self.run(
            "const [element, x, y] = arguments; const box = element.getBoundingClientRect();"
            "for (const kind of ['pointerdown', 'pointerup']) element.dispatchEvent("
            "new PointerEvent(kind, { clientX: box.left + x, clientY: box.top + y,"
            " pointerId: 1, isPrimary: true, bubbles: true }))",
            self._running.find_element("css selector", selector),
            x,
            y,
        )

    def drag(self, *path: tuple[float, float], button: str = "left") -> None:
        """Move the mouse along positions in the page with a button pressed."""
        steps = ["mousePressed", *["mouseMoved"] * (len(path) - 2), "mouseReleased"]
        pressed = {"left": 1, "right": 2}[button]
        for kind, (x, y) in zip(steps, path, strict=True):
            event = {"type": kind, "x": x, "y": y, "button": button, "buttons": pressed}
            self._running.execute_cdp_cmd("Input.dispatchMouseEvent", event | {"clickCount": 1})

    def wheel(self, x: float, y: float, turn: float) -> None:
        """Turn the mouse wheel at a position in the page."""
        event = {"type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": turn}
        self._running.execute_cdp_cmd("Input.dispatchMouseEvent", event)

    def touch(self, *steps: Sequence[tuple[float, float]]) -> None:
        """Put fingers on positions in the page, move them through the steps, and lift them."""
        kinds = ["touchStart", *["touchMove"] * (len(steps) - 1)]
        for kind, places in (*zip(kinds, steps, strict=True), ("touchEnd", ())):
            points = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(places)]
            event = {"type": kind, "touchPoints": points}
            self._running.execute_cdp_cmd("Input.dispatchTouchEvent", event)

    def prefer(self, theme: str) -> None:
        """Emulate a system that prefers the theme "light" or "dark"."""
        features = [{"name": "prefers-color-scheme", "value": theme}]
        self._running.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})

    def violations(self) -> list[str]:
        """Return the accessibility violations that axe finds in the page, as rule and element.

        ARIA rules that axe cannot decide count as violations.
        """
        axe = files("axe_core_python") / "axe.min.js"
        self.run(axe.read_text(encoding="utf-8"))
        return list(
            self.run_later(
                "const done = arguments[arguments.length - 1];"
                "axe.run(document, { resultTypes: ['violations', 'incomplete'] }).then(found => {"
                " const unsure = found.incomplete.filter(v => v.id.startsWith('aria-'));"
                " done([...found.violations, ...unsure]"
                ".flatMap(v => v.nodes.map(n => `${v.id}: ${n.html}`))); });"
            )
        )

    def run_later(self, script: str) -> Any:
        """Run the body of an asynchronous JavaScript function, and return its callback's value."""
        return self._running.execute_async_script(script)

    def wait(self, condition: str) -> None:
        """Wait until a JavaScript expression is true in the page."""
        from selenium.webdriver.support.ui import WebDriverWait

        WebDriverWait(self._running, 20, poll_frequency=0.05).until(
            lambda _: self.run(f"return Boolean({condition})"), condition
        )

    def pixels(self, selector: str) -> "np.ndarray[Any, np.dtype[np.uint8]]":
        """Return the pixels of an element, (h, w, 3) uint8, after all drawing is finished."""
        # A view is drawn roughly while it moves.
        self.wait("![...document.querySelectorAll('.stage')].some(e => e.view?.isMoving)")
        self._running.execute_async_script(
            "const done = arguments[0];"
            "requestAnimationFrame(() => requestAnimationFrame(() => done()))"
        )
        data = self._running.find_element("css selector", selector).screenshot_as_png
        with Image.open(io.BytesIO(data)) as image:
            return np.asarray(image.convert("RGB"))

    def errors(self) -> list[str]:
        """Return the error messages in the console."""
        log = self._running.get_log("browser")
        return [entry["message"] for entry in log if entry["level"] == "SEVERE"]

    def requests(self) -> list[str]:
        """Return the URLs requested since the page was opened."""
        messages = [
            json.loads(e["message"])["message"] for e in self._running.get_log("performance")
        ]
        return [
            message["params"]["request"]["url"]
            for message in messages
            if message["method"] == "Network.requestWillBeSent"
        ]
