"""A picture of a kind of result as one declaration: its line of the help, its caption, what draws it, who has it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Generic, NamedTuple, TypeVar

from matplotlib.figure import Figure

Subject = TypeVar("Subject")


class Picture(NamedTuple, Generic[Subject]):
    """A picture that a command draws.

    Attributes
    ----------
    line : str
        Of the help of the command.
    caption : str
        How it is read, in reports.
    draw : callable
        Of a result; of a comparison, of a torque [N mm], too.
    has : callable
        Whether a result has it.
    """

    line: str
    caption: str
    draw: Callable[..., Figure]
    has: Callable[[Subject], bool] = lambda _: True

    def __call__(self, subject: Subject, *ways: Any, **more: Any) -> Figure:
        """Draw it, whether the result has it or not."""
        return self.draw(subject, *ways, **more)


def figures_of(pictures: Mapping[str, Picture[Subject]], subject: Subject, *ways: Any) -> dict[str, Figure]:
    """Draw the pictures that a result has, by their names."""
    return {name: picture.draw(subject, *ways) for name, picture in pictures.items() if picture.has(subject)}


def captions_of(pictures: Mapping[str, Picture[Any]]) -> dict[str, str]:
    """How the pictures are read, by their names."""
    return {name: picture.caption for name, picture in pictures.items()}
