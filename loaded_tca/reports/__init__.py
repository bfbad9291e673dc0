"""Reports for whoever gets the numbers: one HTML file of a result, a study or a design."""

from loaded_tca.reports.report import write_html_report

__all__ = ["write_html_report"]
