"""Formulae of the site as MathML, which browsers show by themselves: no program is fetched from elsewhere."""

import html
import re

from latex2mathml.converter import convert

_FORMULA = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.DOTALL)


def on_page_content(text, **_):
    """The page with its formulae, which `pymdownx.arithmatex` has set apart, in MathML; called by MkDocs."""

    def formula(found):
        kind, tex = found.groups()
        return convert(html.unescape(tex).strip(), display="block" if kind == "div" else "inline")

    return _FORMULA.sub(formula, text)
