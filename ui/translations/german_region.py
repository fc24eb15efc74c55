# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German for regions, outputs, and what is shown while a run goes on."""

TEXTS = {
    # Region
    "Constraints": "Einschränkungen",
    "Vertices move by their weight in the group of this name: larger weights move farther, vertices with weight 0 or outside of the group stay; empty moves all": (
        "Punkte bewegen sich nach ihrem Gewicht in der Gruppe dieses Namens: größere Gewichte bewegen sich weiter, Punkte mit Gewicht 0 oder außerhalb bleiben; leer bewegt alle"
    ),
    "Vertices move by one minus their weight: larger weights move less": (
        "Punkte bewegen sich um eins minus ihr Gewicht: größere Gewichte bewegen sich weniger"
    ),
    "Leave Hidden Alone": "Verborgenes lassen",
    "Hidden vertices and those of hidden faces stay where they are, in Object Mode too": (
        "Verborgene Punkte und die verborgener Flächen bleiben, wo sie sind, auch im Objektmodus"
    ),
    "Spikes and Islands": "Ausreißer und Inseln",
    "Select Spikes": "Ausreißer auswählen",
    "Flatten Spikes": "Ausreißer einebnen",
    "Select Small Islands": "Kleine Inseln auswählen",
    "Select single vertices and small clusters that are far off their surroundings, in Edit Mode": (
        "Einzelne Punkte und kleine Gruppen auswählen, die weit von ihrer Umgebung entfernt sind, im Bearbeitungsmodus"
    ),
    "Bring spikes down to the surface around them; in Edit Mode the selected ones": (
        "Ausreißer auf die Fläche um sie herum bringen; im Bearbeitungsmodus die ausgewählten"
    ),
    "Select small loose parts in Edit Mode, so that they can be deleted; the largest part is never one": (
        "Kleine lose Teile im Bearbeitungsmodus auswählen, damit sie gelöscht werden können; das größte Teil ist nie darunter"
    ),
    "Least factor from the edges around a spike to its own: larger finds fewer spikes": (
        "Kleinster Faktor von den Kanten um einen Ausreißer zu seinen eigenen: größer findet weniger"
    ),
    "How many vertices a spike has at most: larger finds wider ones": (
        "Wie viele Punkte ein Ausreißer höchstens hat: größer findet breitere"
    ),
    "How many vertices an island has at most: larger selects larger ones": (
        "Wie viele Punkte eine Insel höchstens hat: größer wählt größere aus"
    ),
    "Selected {number:,} vertices of spikes of {names}": "{number:,} Punkte von Ausreißern von {names} ausgewählt",
    "Flattened {number:,} vertices of spikes of {names}": "{number:,} Punkte von Ausreißern von {names} eingeebnet",
    "Selected {number:,} vertices of small islands of {names}": (
        "{number:,} Punkte kleiner Inseln von {names} ausgewählt"
    ),
    "Straighten Borders": "Ränder begradigen",
    "Frayed and zigzag open borders become as smooth as the inside: each follows its own course, and corners stay corners": (
        "Ausgefranste und gezackte offene Ränder werden so glatt wie das Innere: jeder folgt seinem Verlauf, und Ecken bleiben Ecken"
    ),
    "Only vertices of the face set with this number move, those on its border included; another number is another set, 0 all of them": (
        "Nur Punkte des Face-Sets mit dieser Nummer bewegen sich, auch die an seinem Rand; eine andere Nummer ist ein anderes Set, 0 sind alle"
    ),
    "Pick Face Set": "Face-Set wählen",
    "Click a face of the active mesh: only its face set is denoised": (
        "Auf eine Fläche des aktiven Netzes klicken: nur ihr Face-Set wird entrauscht"
    ),
    "Click a face of the set to denoise; Esc or Right Click: Cancel": (
        "Auf eine Fläche des Sets klicken, das entrauscht werden soll; Esc oder Rechtsklick: Abbrechen"
    ),
    "No face of the active mesh is there": "Dort ist keine Fläche des aktiven Netzes",
    "Face set {number}": "Face-Set {number}",
    "level {level} of Multires, the finest, was denoised": (
        "Stufe {level} von Multires, die feinste, wurde entrauscht"
    ),
    "Single vertices and small clusters far off their surroundings come down to them first; Automatic does so by itself, the other engines take them for shape": (
        "Einzelne Punkte und kleine Gruppen weit ab von ihrer Umgebung kommen zuerst auf diese herunter; Automatisch tut das von selbst, die anderen Verfahren halten sie für Form"
    ),
    "Sculpt Mask": "Skulpturmaske",
    "Vertices move by one minus their sculpt mask, in Object Mode too: masked ones stay where they are": (
        "Punkte bewegen sich um eins minus ihre Skulpturmaske, auch im Objektmodus: maskierte bleiben, wo sie sind"
    ),
    "In Sculpt Mode: in place": "Im Skulpturmodus: am Ort",
    "Keep Sharp Edges": "Scharfe Kanten behalten",
    "Edges that are marked sharp or creased stay sharp: their vertices are smoothed along the edges only, and stay where such edges end, meet or turn a corner": (
        "Kanten, die als scharf oder mit Falte markiert sind, bleiben scharf: ihre Punkte werden nur entlang der Kanten geglättet und bleiben, wo solche Kanten enden, sich treffen oder abknicken"
    ),
    "Farthest": "Höchstens",
    "Whether there is a farthest way for vertices": "Ob es einen weitesten Weg für Punkte gibt",
    "None": "Keine",
    "Vertices move as far as the method moves them": "Punkte bewegen sich so weit, wie das Verfahren sie bewegt",
    "Edge Lengths": "Kantenlängen",
    "No vertex moves farther than so many mean edge lengths of its mesh": (
        "Kein Punkt bewegt sich weiter als so viele mittlere Kantenlängen seines Netzes"
    ),
    "No vertex moves farther than a length in the scene": (
        "Kein Punkt bewegt sich weiter als eine Länge in der Szene"
    ),
    "Farthest that any vertex may move, in mean edge lengths: larger removes stronger noise, smaller stays closer to the input": (
        "Wie weit sich ein Punkt höchstens bewegen darf, in mittleren Kantenlängen: größer entfernt stärkeres Rauschen, kleiner bleibt näher an der Vorlage"
    ),
    "Farthest that any vertex may move, in scene units: larger removes stronger noise, smaller stays closer to the input": (
        "Wie weit sich ein Punkt höchstens bewegen darf, in Einheiten der Szene: größer entfernt stärkeres Rauschen, kleiner bleibt näher an der Vorlage"
    ),
    "Along Normals Only": "Nur entlang der Normalen",
    "Vertices move across the surface only, so that textures do not slide; noise along the surface stays": (
        "Punkte bewegen sich nur quer zur Oberfläche, sodass Texturen nicht verrutschen; Rauschen entlang der Oberfläche bleibt"
    ),
    "Keep Volume": "Volumen behalten",
    "Closed meshes keep their volume: what was lost is given back by moving vertices along the normals": (
        "Geschlossene Netze behalten ihr Volumen: was verloren ging, geben Bewegungen entlang der Normalen zurück"
    ),
    "Repair Folds": "Umschläge beheben",
    "Where faces would fold over, their vertices move less": (
        "Wo Flächen umschlagen würden, bewegen sich ihre Punkte weniger"
    ),
    "Keep Seams Closed": "Nähte geschlossen halten",
    "Vertices of borders at exactly the same place count as one for the work and move together, as triangle soups and split seams need; the mesh keeps all its vertices, faces and UV maps": "Punkte von Rändern an genau derselben Stelle zählen für die Arbeit als einer und bewegen sich gemeinsam, wie es Dreieckssuppen und getrennte Nähte brauchen; das Netz behält alle Punkte, Flächen und UV-Karten",
    "Merge Distance": "Abstand",
    "Vertices up to so far apart count as one, in scene units: larger welds wider gaps; 0 only vertices of borders at exactly the same place": "Punkte bis zu diesem Abstand zählen als einer, in Szeneneinheiten: größer verschweißt breitere Spalten; 0 nur Punkte von Rändern an genau derselben Stelle",
    "‘{name}’ has no such group": "‘{name}’ hat keine solche Gruppe",
    # What became of it
    "{:,} (before: {:,})": "{:,} (vorher: {:,})",
    "Folded Faces": "Gefaltet",
    "Faces that look against the faces around them": "Flächen, die gegen die Flächen um sie herum blicken",
    "Folded Faces Before": "Vorher gefaltet",
    "Faces that looked against the faces around them before": (
        "Flächen, die vorher gegen die Flächen um sie herum blickten"
    ),
    "Degenerate": "Entartet",
    "Faces next to without area": "Flächen beinahe ohne Inhalt",
    "Degenerate Before": "Vorher entartet",
    "Faces next to without area before": "Flächen, die vorher beinahe ohne Inhalt waren",
    "Damped": "Gedämpft",
    "Vertices that moved less, so that no face folds": (
        "Punkte, die sich weniger bewegten, damit keine Fläche umschlägt"
    ),
    "On Lines": "Auf Linien",
    "Vertices on sharp edges, which were smoothed along them only": (
        "Punkte auf scharfen Kanten, die nur entlang dieser geglättet wurden"
    ),
    "Welded": "Verbunden",
    "Vertices that were welded to others for the run": "Punkte, die für den Lauf mit anderen verbunden waren",
    # Output
    "Output": "Ausgabe",
    "Where the denoised surface goes": "Wohin die entrauschte Oberfläche kommt",
    "In Place": "An Ort und Stelle",
    "The mesh itself is changed; with shape keys, the active one": (
        "Das Netz selbst wird geändert; mit Formschlüsseln der aktive"
    ),
    "Shape Key": "Formschlüssel",
    "A new shape key holds the result; its value sets the amount, also later, and can be keyed": (
        "Ein neuer Formschlüssel enthält das Ergebnis; sein Wert bestimmt das Maß, auch später, und lässt sich animieren"
    ),
    "New Object": "Neues Objekt",
    "A copy of the object holds the result; the original stays as it is": (
        "Eine Kopie des Objekts enthält das Ergebnis; das Original bleibt, wie es ist"
    ),
    "Its value is the amount": "Sein Wert ist das Maß",
    "The original stays as it is": "Das Original bleibt, wie es ist",
    "Needs Object Mode": "Braucht den Objektmodus",
    "Cancel the run that is going on; everything stays as it was": (
        "Den laufenden Vorgang abbrechen; alles bleibt, wie es war"
    ),
    # Live preview
    "Show on the active mesh what the settings would give, while they are changed; Esc ends it": (
        "Am aktiven Netz zeigen, was die Einstellungen ergäben, während sie geändert werden; Esc beendet es"
    ),
    "Keep what the preview shows, in the place that Output says": (
        "Behalten, was die Vorschau zeigt, dort, wo es die Ausgabe vorsieht"
    ),
    "Make a mesh object active": "Ein Netz aktiv machen",
    "The live preview is off": "Die Vorschau ist aus",
    "The preview does not show these settings yet": "Die Vorschau zeigt diese Einstellungen noch nicht",
    "Preview of {name}": "Vorschau von {name}",
    "{progress}, {time} left": "{progress}, noch {time}",
    # A run that goes on
    "Framelet is not running": "Framelet läuft nicht",
    "Framelet is running; press Esc in the 3D View to cancel": "Framelet läuft; Esc in der 3D-Ansicht bricht ab",
    "Canceled; nothing was changed": "Abgebrochen; nichts wurde geändert",
    "Denoising ‘{name}’": "‘{name}’ wird entrauscht",
    "Denoising ‘{name}’ ({number} of {total})": "‘{name}’ wird entrauscht ({number} von {total})",
    "{what}: preparing": "{what}: Vorbereitung",
    "{progress}   |   Esc or Right Click in the View: Cancel": (
        "{progress}   |   Esc oder Rechtsklick in der Ansicht: Abbrechen"
    ),
    "Denoised {names} in {seconds:.1f} s": "{names} in {seconds:.1f} s entrauscht",
    "; noise {noise}": "; Rauschen {noise}",
    "; used {what}": "; verwendet: {what}",
    "‘{name}’ is far from the origin of its object, where positions come in steps of {edges:.2g} edge lengths; "
    "move its vertices there first": "‘{name}’ liegt weit vom Ursprung seines Objekts, wo Positionen in Schritten "
    "von {edges:.2g} Kantenlängen liegen; verschieben Sie zuerst die Punkte dorthin",
    "; clean already": "; schon sauber",
    "; Strength is 0": "; Stärke ist 0",
    "it is made of voxels: the preset Marching Cubes / CT rounds the steps": (
        "es besteht aus Voxeln: die Vorgabe Marching Cubes / CT rundet die Stufen"
    ),
    "its heights are in whole steps: the preset Paper Tri-2 takes them away": (
        "seine Höhen haben ganze Stufen: die Vorgabe Artikel Tri-2 nimmt sie weg"
    ),
    "if what is left is noise, it is several edges wide: set Noise to Wide": (
        "falls der Rest Rauschen ist, ist es mehrere Kanten breit: Rauschen auf Breit stellen"
    ),
    "the object is scaled unevenly: apply its scale (Ctrl A) and denoise again": (
        "das Objekt ist ungleich skaliert: seine Skalierung anwenden (Strg A) und noch einmal entrauschen"
    ),
    "the cage was denoised: to clean what Subdivision shows, apply it first": (
        "das Grundnetz wurde entrauscht: für das, was Unterteilung zeigt, den Modifikator zuerst anwenden"
    ),
    ": noise of {lengths} removed": ": Rauschen von {lengths} entfernt",
}
