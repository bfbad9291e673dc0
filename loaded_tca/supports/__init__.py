"""Supports: what holds both gears, and how they move as whole bodies under load."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.supports.of_scene import support_compliance, supports_of
    from loaded_tca.supports.support import Support, SupportCompliance, moved_pair
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = ["Support", "SupportCompliance", "moved_pair", "support_compliance", "supports_of"]
