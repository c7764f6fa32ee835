"""Help → About tells name and version, and the licences of what is inside."""

from PySide6.QtWidgets import QMessageBox

from app import __version__


def boxes(wiring) -> dict[str, QMessageBox]:
    return {box.windowTitle(): box for box in wiring.window_.findChildren(QMessageBox) if box.isVisible()}


def test_the_licences_of_what_is_inside_are_a_button_away(qtbot, wiring):
    wiring.window_.actions_["about"].trigger()
    about = boxes(wiring)["About Hitofude"]
    assert __version__ in about.text()
    next(button for button in about.buttons() if button.text() == "Licences…").click()
    licences = boxes(wiring)["Licences"]
    assert "numpy" in licences.text() and "LGPL" in licences.text()
    assert "Permission is hereby granted" in licences.detailedText()
    licences.close()
    about.close()
