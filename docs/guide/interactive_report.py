"""Draw ``interactive_report.png``: the interactive page of the demo, as a browser shows it at first.

Run from the root of the repository: ``python -m docs.guide.interactive_report``. Needs the extra ``interactive``,
selenium, chromium and chromedriver.
"""

import io
import shutil
import time
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image
from selenium import webdriver

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.cli import DEMO_SCENE

PICTURE = Path(__file__).with_suffix(".png")
WINDOW, WIDTH = (1200, 1100), 948
"""Pixels of the window with its frame, and of the picture."""
CHANGES = {"analysis.positions": 33, "analysis.torques_Nm": (50.0, 100.0, 150.0), "analysis.root_stress": True}
FLAGS = "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--hide-scrollbars"
PATIENCE = 60.0
"""Seconds until the page is drawn, at most."""


def main() -> None:
    """Analyse the demo, open its page and save what the window shows."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts reach the end of the face
        page = analyse(read_scene(DEMO_SCENE).with_changes(CHANGES)).explore()
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium") or shutil.which("google-chrome") or ""
    with TemporaryDirectory() as folder:
        for flag in (*FLAGS, f"--window-size={WINDOW[0]},{WINDOW[1]}", f"--user-data-dir={folder}/profile"):
            options.add_argument(flag)
        driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
        try:
            driver.get(page.save(Path(folder, "page.html")).as_uri())
            end = time.monotonic() + PATIENCE
            while not driver.execute_script("return document.documentElement.dataset.ready"):
                if time.monotonic() > end:
                    raise TimeoutError("the page is not drawn")
                time.sleep(0.1)
            time.sleep(1.0)  # colour bars come after
            shot = Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB")
        finally:
            driver.quit()
    small = shot.resize((WIDTH, round(WIDTH * shot.height / shot.width)), Image.Resampling.LANCZOS)
    small.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(PICTURE, optimize=True)


if __name__ == "__main__":
    main()
