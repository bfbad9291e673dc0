"""Contacts without gears
======================

A crowned roller and a rough ball from plain arrays, elastic and with a cap. The roller, 20 mm in diameter and length
under 40 kN, has the logarithmic profile of ISO/TS 16281 for an even pressure. Writes contact_from_arrays.png.
"""

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import solve_contact
from loaded_tca.reference import hertz

STEEL = 210000.0 / (2.0 * (1.0 - 0.3**2))  # E* of two steel bodies, MPa


def centres(cells: int, width: float) -> np.ndarray:
    """Centres of the cells of a box around zero, mm."""
    return ((np.arange(cells) + 0.5) / cells - 0.5) * width


def roller_gap(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Gap of the roller over a plate, mm: its radius across, the logarithmic drop along."""
    drop = -0.00035 * 20.0 * np.log(1.0 - (2.0 * y / 20.0) ** 2)
    return x[:, None] ** 2 / 20.0 + drop


def rough_gap(x: np.ndarray) -> np.ndarray:
    """Gap of a ball of 20 mm diameter with a random roughness of 0.2 um, mm: eight cells for its shortest waves."""
    waves = np.hypot(*np.meshgrid(np.fft.fftfreq(x.size), np.fft.fftfreq(x.size)))
    noise = np.random.default_rng(1).standard_normal((x.size, x.size))
    roughness = np.fft.ifft2(np.fft.fft2(noise) * np.where(waves < 1.0 / 8.0, (waves + 0.02) ** -1.8, 0.0)).real
    return (x[:, None] ** 2 + x**2) / 20.0 + 0.0002 * roughness / roughness.std()


def main() -> float:
    """Return the pressure in the middle of the roller over that of an endless one (2710 MPa)."""
    x, y, z = centres(96, 1.5), centres(384, 20.0), centres(192, 0.9)
    figure = Figure(figsize=(10.0, 7.0), layout="constrained")
    for row, cap in zip(figure.subplots(2, 3), (None, 2500.0), strict=True):
        options = {"contact_modulus": STEEL, "max_pressure": cap}
        roller = solve_contact(roller_gap(x, y), spacing=(x[1] - x[0], y[1] - y[0]), load=40000.0, **options)
        rough = solve_contact(rough_gap(z), spacing=(z[1] - z[0],) * 2, load=250.0, **options)
        row[0].pcolormesh(y, x, roller.pressure, vmin=0.0, vmax=3000.0)
        title = f"roller, cap {cap:.0f} MPa" if cap else "roller, elastic"
        row[0].set(title=title, xlabel="along [mm]", ylabel="across [mm]")
        row[1].plot(y, roller.pressure[48])
        row[1].set(title=f"approach {1e3 * roller.approach:.1f} µm", xlabel="along [mm]", ylabel="pressure [MPa]")
        colours = row[2].pcolormesh(z, z, rough.pressure, vmin=0.0, vmax=3000.0)
        figure.colorbar(colours, ax=row[2], label="pressure [MPa]", extend="max")
        row[2].set(title=f"rough ball, peak {rough.peak_pressure:.0f} MPa", xlabel="[mm]", aspect="equal")
        if cap is None:
            middle = float(roller.pressure[47:49, 191:193].mean())
    figure.savefig("contact_from_arrays.png", dpi=120)
    return middle / hertz.line_contact(2000.0, 0.1, STEEL).max_pressure


if __name__ == "__main__":
    print(f"middle of the roller over an endless one: {main():.3f}")
