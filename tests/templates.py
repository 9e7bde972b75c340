"""What the templates of documents ask for."""

from ratd.pipeline.documents import _SLOT


def slots(template):
    """Names of the slots of a template, in their order, list of str."""
    return [name for name, _, _ in _SLOT.findall(template)]
