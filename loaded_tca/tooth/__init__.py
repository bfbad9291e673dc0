"""Complete teeth: flanks, fillets, tip and root lands as one surface, for every kind of gear."""

from loaded_tca.tooth import bevel, cylindrical, face_milled
from loaded_tca.tooth.build import Resolution, build_tooth
from loaded_tca.tooth.fillet import ArcFillet, Fillet, FilletCurve, RackFillet
from loaded_tca.tooth.form import RootCone, RootCylinder, ToothForm, tooth_forms
from loaded_tca.tooth.sections import ApexSpheres, Sections, TransversePlanes
from loaded_tca.tooth.surface import PATCHES, ToothSurface
from loaded_tca.tooth.triangles import TriangleMesh

__all__ = [
    "PATCHES",
    "ApexSpheres",
    "ArcFillet",
    "Fillet",
    "FilletCurve",
    "RackFillet",
    "Resolution",
    "RootCone",
    "RootCylinder",
    "Sections",
    "ToothForm",
    "ToothSurface",
    "TransversePlanes",
    "TriangleMesh",
    "bevel",
    "build_tooth",
    "cylindrical",
    "face_milled",
    "tooth_forms",
]
