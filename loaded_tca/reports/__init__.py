"""Reports of a result, a study or a design as one HTML file, printed or interactive, and their cards in notebooks."""

from loaded_tca.reports.interactive import InteractivePage, explore
from loaded_tca.reports.notebook import Card, card_of
from loaded_tca.reports.report import write_html_report

__all__ = ["Card", "InteractivePage", "card_of", "explore", "write_html_report"]
