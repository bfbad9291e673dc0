"""Complete teeth: flanks, fillets, tip and root lands as one surface, for every kind of gear."""

from loaded_tca.tooth.bevel import BevelTooth
from loaded_tca.tooth.build import Resolution, build_tooth
from loaded_tca.tooth.cylindrical import CylindricalTooth
from loaded_tca.tooth.face_milled import FaceMilledTooth
from loaded_tca.tooth.fillet import ArcFillet, Fillet, FilletCurve, RackFillet
from loaded_tca.tooth.form import RootCone, RootCylinder, ToothForm
from loaded_tca.tooth.geometry import ToothGeometry
from loaded_tca.tooth.sections import ApexSpheres, Sections, TransversePlanes
from loaded_tca.tooth.surface import PATCHES, ToothSurface
from loaded_tca.tooth.triangles import TriangleMesh

__all__ = [
    "PATCHES",
    "ApexSpheres",
    "ArcFillet",
    "BevelTooth",
    "CylindricalTooth",
    "FaceMilledTooth",
    "Fillet",
    "FilletCurve",
    "RackFillet",
    "Resolution",
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
