"""Reports of a result, a study or a design as one HTML file."""

from loaded_tca.reports.report import write_html_report

__all__ = ["write_html_report"]
