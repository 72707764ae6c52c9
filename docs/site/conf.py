"""Sphinx: the documents as they lie in the repository, as a site (`./dev docs`). Their links are those that work in a
checkout; one that leads nowhere fails the build."""
import pathlib

from docutils import nodes

root = pathlib.Path(__file__).resolve().parents[2]
project, html_title = 'Pliant', 'Pliant'
extensions = ['myst_parser']
root_doc = 'README'
include_patterns = ['README.md', 'CHANGELOG.md', 'docs/**.md', 'content/README.md', 'bench/**.md', 'bindings/**.md',
                    'examples/**.md', 'packaging/**.md']
exclude_patterns = ['build', 'docs/reference/node_modules']
myst_heading_anchors = 6
suppress_warnings = ['myst.header', 'misc.highlighting_failure']
html_theme = 'furo'
html_copy_source = False
html_show_sphinx = False

GROUPS = {
    'Use it': ['docs/first-level', 'docs/cli', 'docs/editor', 'docs/level-format', 'content/README', 'docs/clip',
               'docs/codes'],
    'Build on it': ['docs/embedding', 'docs/python', 'docs/web', 'docs/walks', 'docs/devices', 'docs/devices/safety',
                    'docs/devices/protocols', 'docs/devices/simulated', 'bindings/unity/README', 'bindings/unreal/README',
                    'bindings/godot/README'],
    'How exact it is': ['docs/methods', 'docs/accuracy', 'docs/studies', 'docs/sweep', 'docs/fit', 'docs/reference',
                        'bench/results/README', 'bench/results/studies/README'],
}


def contents(app, docname, source):
    """The README is the front page: it gets the list of the other pages. Two pages lead to Doxygen's."""
    if docname in (root_doc, 'docs/embedding'):
        source[0] += f'\n<p><a href="{"../" * docname.count("/")}api/index.html">The C and C++ headers</a></p>\n'
    if docname == root_doc:
        for caption, pages in GROUPS.items():
            source[0] += f'\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n' + '\n'.join(pages) + '\n```\n'
        source[0] += '\n```{toctree}\n:hidden:\n\nCHANGELOG\n```\n'


def folder(app, env, node, contnode):
    """A link to a folder leads to its README, else it is text; of a file, to its name."""
    target = node['reftarget'].split('#')[0]
    here = pathlib.Path(env.doc2path(node['refdoc'])).parent
    path = (here / target).resolve()
    if not path.exists() or root not in path.parents:
        return None
    readme = path / 'README.md'
    name = str(readme.relative_to(root).with_suffix(''))
    if readme.exists() and name in env.found_docs:
        return nodes.reference('', '', contnode, internal=True, refuri=app.builder.get_relative_uri(node['refdoc'], name))
    return nodes.literal(str(path.relative_to(root)), str(path.relative_to(root)))


def front(app, error):
    if not error:
        pathlib.Path(app.outdir, 'index.html').write_text('<!doctype html><meta http-equiv="refresh" content="0;url=README.html">'
                                                          '<a href="README.html">Pliant</a>\n')


def setup(app):
    app.connect('source-read', contents)
    app.connect('missing-reference', folder, priority=400)
    app.connect('build-finished', front)
