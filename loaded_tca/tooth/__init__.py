"""Complete teeth: flanks, fillets, tip and root lands as one surface, for every kind of gear."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.tooth.face_milled import FaceMilledTooth
    from loaded_tca.tooth.families import (
        BevelTooth,
        CylindricalTooth,
        RootCone,
        RootCylinder,
        ToothForm,
        ToothGeometry,
    )
    from loaded_tca.tooth.fillet import (
        ApexSpheres,
        ArcFillet,
        Fillet,
        FilletCurve,
        RackFillet,
        Sections,
        TransversePlanes,
    )
    from loaded_tca.tooth.ring import InvertedPlanes, RingFillet, RingTooth
    from loaded_tca.tooth.surface import PATCHES, Resolution, ToothSurface, TriangleMesh, build_tooth
else:
    __getattr__, __dir__ = lazy_names(__name__)

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
