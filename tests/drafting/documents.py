"""Documents of some lines."""

from app.drafting.document import Document


def drawn(*lines: str) -> Document:
    """A document in which lines of the shape language were carried out."""
    document = Document()
    for line in lines:
        document.run(line)
    return document
