# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German for operators: their names, their tooltips, why they are gray, and what they report."""

NAMES = {
    "Add Framelet Preset": "Framelet-Vorgabe hinzufügen",
    "Add Noise": "Rauschen hinzufügen",
    "Analyze": "Zerlegen",
    "Angle Change": "Winkeländerung",
    "Apply": "Anwenden",
    "Before/After": "Vorher/Nachher",
    "Cancel": "Abbrechen",
    "Clear Bands": "Bänder entfernen",
    "Compare": "Vergleichen",
    "Denoise": "Entrauschen",
    "Denoise (Framelet)": "Entrauschen (Framelet)",
    "Equalize": "Equalizer anwenden",
    "Estimate Noise": "Rauschen messen",
    "Heat Map": "Wärmebild",
    "Hide Colors": "Farben ausblenden",
    "Live Preview": "Live-Vorschau",
    "Noise Map": "Rauschkarte",
    "Noise Width": "Rauschbreite",
    "Rebuild": "Zusammensetzen",
    "Show Band": "Band zeigen",
}
"""Names of operators and texts on their buttons."""

TEXTS = {
    # Tooltips
    "Remove noise from the selected meshes; in Edit Mode only the selected vertices move": (
        "Rauschen aus den ausgewählten Netzen entfernen; im Bearbeitungsmodus bewegen sich nur die ausgewählten "
        "Punkte"
    ),
    "Measure how strong the noise of the selected meshes is, where they may move; changes nothing": (
        "Messen, wie stark das Rauschen der ausgewählten Netze ist; ändert nichts"
    ),
    "Move vertices along their normals by random amounts, to try out what denoising does": (
        "Punkte zufällig entlang ihrer Normalen verschieben, um das Entrauschen auszuprobieren"
    ),
    "Measure how far the active mesh is from the other selected one, which must have the same faces": (
        "Messen, wie weit das aktive Netz vom anderen ausgewählten entfernt ist, das dieselben Flächen haben muss"
    ),
    "Split the selected meshes into bands, and store these as attributes for nodes, scripts and display": (
        "Die ausgewählten Netze in Bänder zerlegen und diese als Attribute für Nodes, Skripte und Anzeige speichern"
    ),
    "Show a stored band of the selected meshes as vertex colors": (
        "Ein gespeichertes Band der ausgewählten Netze in Farben zeigen"
    ),
    "Rebuild the selected meshes from their stored bands, edited or not": (
        "Die ausgewählten Netze aus ihren gespeicherten Bändern zusammensetzen, ob bearbeitet oder nicht"
    ),
    "Remove all that Framelet stored on the selected meshes: bands, colors, the noise, and modifiers": (
        "Alles entfernen, was Framelet an den ausgewählten Netzen gespeichert hat: Bänder, Farben, das Rauschen und Modifikatoren"
    ),
    "Smooth or exaggerate the details of meshes, scale by scale; in Edit Mode those of selected vertices": (
        "Einzelheiten von Netzen glätten oder übertreiben, Größe für Größe; im Bearbeitungsmodus die der "
        "ausgewählten Punkte"
    ),
    "Move the vertices of the selected meshes to where they were before the last run, or back": (
        "Die Punkte der ausgewählten Netze dorthin bewegen, wo sie vor dem letzten Lauf waren, oder zurück"
    ),
    "Show as colors how the last run moved the selected meshes and their faces, or which noise it removed": (
        "In Farben zeigen, wie der letzte Lauf die ausgewählten Netze und ihre Flächen bewegte oder welches Rauschen "
        "er entfernte"
    ),
    "Remove the colors of heat maps and bands from the selected meshes, and show what was shown before": (
        "Die Farben von Wärmebildern und Bändern von den ausgewählten Netzen entfernen und zeigen, was vorher zu "
        "sehen war"
    ),
    "Save the engine and its settings as a preset of your own, or remove the one that is active": (
        "Das Verfahren und seine Einstellungen als eigene Vorgabe speichern oder die aktive entfernen"
    ),
    # Properties of single operators
    "Standard deviation of the noise, in mean edge lengths: larger is noisier": (
        "Standardabweichung des Rauschens, in mittleren Kantenlängen: größer rauscht stärker"
    ),
    "Seed": "Startwert",
    "Another number gives other noise of the same strength": (
        "Eine andere Zahl gibt anderes Rauschen derselben Stärke"
    ),
    "Other": "Anderes",
    "Name of the object to compare with; empty takes the other selected mesh object": (
        "Name des Objekts zum Vergleich; leer nimmt das andere ausgewählte Netz"
    ),
    # Why a button is gray
    "Switch to Object Mode": "In den Objektmodus wechseln",
    "Switch to Object Mode, or to Edit Mode or Sculpt Mode of a mesh": (
        "In den Objektmodus, Bearbeitungsmodus oder Skulpturmodus eines Netzes wechseln"
    ),
    "Select at least one mesh object": "Mindestens ein Netz auswählen",
    "Analyze a selected mesh first: none has stored bands": (
        "Zuerst ein ausgewähltes Netz zerlegen: keines hat gespeicherte Bänder"
    ),
    "The selected meshes have nothing to remove": "Die ausgewählten Netze haben nichts zu entfernen",
    "The selected meshes have no colors of Framelet": "Die ausgewählten Netze haben keine Farben von Framelet",
    "The active object must be a mesh": "Das aktive Objekt muss ein Netz sein",
    "Denoise a selected mesh first": "Zuerst ein ausgewähltes Netz entrauschen",
    # What a script is told
    "The engine {engine} does not use {names}; give {argument} for one that does.": (
        "Das Verfahren {engine} verwendet {names} nicht; {argument} nimmt eines, das es tut."
    ),
    "{name} has no effect with {argument}.": "{name} wirkt nicht mit {argument}.",
    "{name} has no effect without {argument}.": "{name} wirkt nicht ohne {argument}.",
    # Reports
    "{number} objects": "{number} Objekten",
    "Added noise of {sigma:g} edge lengths to {names}": (
        "Rauschen von {sigma:g} Kantenlängen zu {names} hinzugefügt"
    ),
    "Stored {number} bands of {names}: {size}": "{number} Bänder von {names} gespeichert: {size}",
    "Removed the bands of {names}": "Bänder von {names} entfernt",
    "Rebuilt {names}: vertices moved by up to {length}": (
        "Aus Bändern von {names} zusammengesetzt: Punkte bewegten sich bis zu {length}"
    ),
    "Equalized {names}: vertices moved by up to {length}": (
        "Equalizer auf {names} angewandt: Punkte bewegten sich bis zu {length}"
    ),
    "Showing {names} before denoising": "Zustand von {names} vor dem Entrauschen",
    "Showing {names} after denoising": "Zustand von {names} nach dem Entrauschen",
    "{title} of {names}: colors from {lowest} to {highest}, {share:.1f}% of all are within": (
        "{title} von {names}: Farben von {lowest} bis {highest}, {share:.1f} % aller Werte liegen darin"
    ),
    "Noise of {names}: {noise}": "Rauschen von {names}: {noise}",
    "Noise of what may move of {names}: {noise}": (
        "Rauschen dessen, was sich von {names} bewegen darf: {noise}"
    ),
    "Noise of {names}: from {least} of ‘{first}’ to {most} of ‘{last}’": (
        "Rauschen von {names}: von {least} an ‘{first}’ bis {most} an ‘{last}’"
    ),
    "{length} ({edges:.3f} edge lengths)": "{length} ({edges:.3f} Kantenlängen)",
    "{length} ({edges:.3f} edge lengths, impulsive)": "{length} ({edges:.3f} Kantenlängen, mit Ausreißern)",
    "‘{name}’ against ‘{other}’: {angle:.3f}° mean angle, {distance} RMS distance ({edges:.3f} edge lengths)": (
        "‘{name}’ gegen ‘{other}’: {angle:.3f}° mittlerer Winkel, {distance} mittlerer Abstand "
        "({edges:.3f} Kantenlängen)"
    ),
}
"""Everything else."""
