"""Reports of a result, a study or a design as one HTML file, printed or interactive."""

from loaded_tca.reports.interactive import InteractivePage, explore
from loaded_tca.reports.report import write_html_report

__all__ = ["InteractivePage", "explore", "write_html_report"]
