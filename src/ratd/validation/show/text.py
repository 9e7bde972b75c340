"""Numbers and tables in Markdown, as the sections of the checks use them."""

from ratd.markdown import markdown_table, measured

__all__ = ["markdown_table", "measured"]
