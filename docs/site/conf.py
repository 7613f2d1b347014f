"""Sphinx settings of the documentation site. tools/docs.sh runs Sphinx on the pages that tools/stage_site.py writes."""

from sphinx.ext.napoleon import Config
from sphinx.ext.napoleon.docstring import NumpyDocstring

project = "Blum"
copyright = "the Blum authors"  # noqa: A001
extensions = ["myst_parser", "sphinx.ext.autodoc"]
root_doc = "index"
# Pages state their headings' anchors as GitHub makes them, so that links hold on both.
myst_heading_anchors = 4
myst_links_external_new_tab = False
suppress_warnings = ["myst.header", "ref.python"]  # pages may start at any level; names of attributes are many


# Docstrings state the types, in words of the guide.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "show-inheritance": True}
# Otherwise types such as "mesh" become links to any attribute of that name.
NUMPY_STYLE = Config(napoleon_use_param=False, napoleon_use_rtype=False)

html_theme = "furo"
html_title = "Blum"
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True}


def read_sections(app, what, name, obj, options, lines):
    """Converts the sections of a NumPy docstring.

    The parser does not get the name of an attribute. With a name, it takes the words before the first colon of the
    attribute's text as a type.
    """
    lines[:] = NumpyDocstring(list(lines), NUMPY_STYLE, app, what, "", obj, options).lines()


def escape_bars(app, what, name, obj, options, lines):  # noqa: ARG001
    """|x| is an absolute value in docstrings, not a substitution."""
    for number, line in enumerate(lines):
        if not line.lstrip().startswith(">>>"):
            lines[number] = line.replace("|", "\\|")


def setup(app):
    app.connect("autodoc-process-docstring", read_sections)
    app.connect("autodoc-process-docstring", escape_bars)
