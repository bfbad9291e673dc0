"""Teeth of an undercut pinion in mesh
===================================

A pinion of ten teeth without profile shift: the trochoid of its fillet cuts into the involute, and the path of contact
begins where they cross. Writes teeth_in_mesh.png and prints what the undercut takes.
"""

from pathlib import Path

from loaded_tca import read_scene
from loaded_tca.gears import undercuts
from loaded_tca.plots import plot_teeth_in_mesh, save_figure

SCENE = Path(__file__).parent / "scenes" / "undercut_10x40.toml"


def main() -> float:
    """Return the path of contact that is left and the part that is lost, over that of a whole involute: 1."""
    scene = read_scene(SCENE)
    mesh = scene.mesh()
    pinion, _ = undercuts(mesh)
    print(f"the flank ends at d_Ff = {2.0 * pinion.form_radius:.4f} mm: {pinion.lost_length:.3f} mm are lost")
    print(f"contact ratio {pinion.ratio:.3f} instead of {pinion.whole_ratio:.3f}")
    save_figure(plot_teeth_in_mesh(scene), "teeth_in_mesh.png")
    tip = mesh.pinion.roll_length(mesh.pinion.tip_radius)  # a whole involute is in contact from the base circle on
    return (mesh.path_of_contact.AE + pinion.lost_length) / tip


if __name__ == "__main__":
    main()
