"""Complete teeth: flanks, fillets, tip and root lands as one surface, for every kind of gear."""

from loaded_tca.tooth.families import (
    BevelTooth,
    CylindricalTooth,
    FaceMilledTooth,
    RootCone,
    RootCylinder,
    ToothForm,
    ToothGeometry,
)
from loaded_tca.tooth.fillet import ApexSpheres, ArcFillet, Fillet, FilletCurve, RackFillet, Sections, TransversePlanes
from loaded_tca.tooth.ring import InvertedPlanes, RingFillet, RingTooth
from loaded_tca.tooth.surface import PATCHES, Resolution, ToothSurface, TriangleMesh, build_tooth

__all__ = [
    "PATCHES",
    "ApexSpheres",
    "ArcFillet",
    "BevelTooth",
    "CylindricalTooth",
    "FaceMilledTooth",
    "Fillet",
    "FilletCurve",
    "InvertedPlanes",
    "RackFillet",
    "Resolution",
    "RingFillet",
    "RingTooth",
    "RootCone",
    "RootCylinder",
    "Sections",
    "ToothForm",
    "ToothGeometry",
    "ToothSurface",
    "TransversePlanes",
    "TriangleMesh",
    "build_tooth",
]
