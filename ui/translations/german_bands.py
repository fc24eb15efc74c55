# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German for frames, bands, the equalizer and the heat map."""

TEXTS = {
    # Frames
    "Box spline on triangles, linear spline on quads, adaptive on anything else": (
        "Box-Spline auf Dreiecken, linearer Spline auf Vierecken, adaptiv auf allem anderen"
    ),
    "Box Spline": "Box-Spline",
    "Triangles: linear box spline in three directions, six high-pass masks (3.5); the paper's choice": (
        "Dreiecke: linearer Box-Spline in drei Richtungen, sechs Hochpass-Masken (3.5); die Wahl des Artikels"
    ),
    "Box Spline, Canonical": "Box-Spline, kanonisch",
    "Triangles: the same low-pass with seven high-pass masks (3.8)": (
        "Dreiecke: derselbe Tiefpass mit sieben Hochpass-Masken (3.8)"
    ),
    "Box Spline, Four Directions": "Box-Spline, vier Richtungen",
    "Cells: box spline in four directions, eleven high-pass masks (Example 3.2); smoother": (
        "Zellen: Box-Spline in vier Richtungen, elf Hochpass-Masken (Beispiel 3.2); glatter"
    ),
    "Linear Spline": "Linearer Spline",
    "Quads: bilinear spline, eight high-pass masks (5.1); the paper's choice": (
        "Vierecke: bilinearer Spline, acht Hochpass-Masken (5.1); die Wahl des Artikels"
    ),
    "Linear Spline, Reduced": "Linearer Spline, verkürzt",
    "Quads: the same low-pass with five high-pass masks (5.4)": (
        "Vierecke: derselbe Tiefpass mit fünf Hochpass-Masken (5.4)"
    ),
    "B-Spline 1 (Haar)": "B-Spline 1 (Haar)",
    "Cells: 2x2 masks, the most local frame": "Zellen: 2x2-Masken, der örtlichste Frame",
    "B-Spline 2": "B-Spline 2",
    "Quads: 3x3 masks, the linear spline up to signs": (
        "Vierecke: 3x3-Masken, der lineare Spline bis auf Vorzeichen"
    ),
    "B-Spline 3": "B-Spline 3",
    "Cells: 4x4 masks of the quadratic spline": "Zellen: 4x4-Masken des quadratischen Splines",
    "B-Spline 4": "B-Spline 4",
    "Quads: 5x5 masks of the cubic spline": "Vierecke: 5x5-Masken des kubischen Splines",
    "B-Spline 5": "B-Spline 5",
    "Cells: 6x6 masks, wide and smooth": "Zellen: 6x6-Masken, weit und glatt",
    "B-Spline 6": "B-Spline 6",
    "Quads: 7x7 masks, the widest and smoothest frame": "Vierecke: 7x7-Masken, der weiteste und glatteste Frame",
    "Any mesh: masks that fit each vertex's valence; exactly tight at every vertex": (
        "Jedes Netz: Masken, die zur Valenz jedes Punktes passen; an jedem Punkt genau straff"
    ),
    "Pairwise": "Paarweise",
    "Any mesh: low-pass and all differences within a one-ring; exactly tight, many bands": (
        "Jedes Netz: Tiefpass und alle Differenzen im Einsring; genau straff, viele Bänder"
    ),
    "For quads; this mesh has none": "Für Vierecke; dieses Netz hat keine",
    "For triangles; this mesh has none": "Für Dreiecke; dieses Netz hat keine",
    "Needs quads or pairs of triangles": "Braucht Vierecke oder Dreieckspaare",
    "Not for this mesh: frames for quads": "Nicht für dieses Netz: Frames für Vierecke",
    "Not for this mesh: frames for triangles": "Nicht für dieses Netz: Frames für Dreiecke",
    # Bands
    "Bands": "Bänder",
    "Band": "Band",
    "Allowed": "Erlaubt",
    "Allowed MB": "Erlaubte MB",
    "Megabytes that the bands of a mesh may take, or nothing is stored: larger allows more": (
        "Megabytes, die die Bänder eines Netzes belegen dürfen, sonst wird nichts gespeichert: größer erlaubt mehr"
    ),
    "Show": "Zeigen",
    "What the colors are made from": "Woraus die Farben gemacht sind",
    "One band of a level": "Ein Band einer Stufe",
    "All bands of a level together: the norm over its bands": (
        "Alle Bänder einer Stufe zusammen: die Norm über ihre Bänder"
    ),
    "Low-Pass": "Tiefpass",
    "How far the low-pass, which is left after all levels, is from the surface": (
        "Wie weit der Tiefpass, der nach allen Stufen übrig ist, von der Oberfläche entfernt ist"
    ),
    "Level": "Stufe",
    "Which scale: larger is coarser; 1 is the finest, each further one is twice as coarse": (
        "Welche Größe: größer ist gröber; 1 ist die feinste, jede weitere doppelt so grob"
    ),
    "Which band of the level: larger is a later row of the mask-matrix": (
        "Welches Band der Stufe: größer ist eine spätere Zeile der Maskenmatrix"
    ),
    "Value": "Wert",
    "Which number is taken from the vectors of a band": "Welche Zahl von den Vektoren eines Bandes genommen wird",
    "Along Normal": "Entlang der Normale",
    "Component along the vertex normal: positive points outwards": (
        "Anteil entlang der Punktnormale: positiv zeigt nach außen"
    ),
    "Length": "Länge",
    "Length of the vector, whatever its direction": "Länge des Vektors, gleich in welcher Richtung",
    "No bands that can be read": "Keine lesbaren Bänder",
    "Needs": "Braucht",
    "Stored": "Gespeichert",
    "1 level, {bands} bands": "1 Stufe, {bands} Bänder",
    "{levels} levels, {bands} bands": "{levels} Stufen, {bands} Bänder",
    "Colors": "Farben",
    "Blue": "Blau",
    "Gray": "Grau",
    "Red": "Rot",
    "Violet": "Violett",
    "Within": "Darin",
    "{:.1f}% of vertices": "{:.1f} % der Punkte",
    # The range of colors
    "Range": "Bereich",
    "Which values get the last colors of the map; values beyond look the same as those": (
        "Welche Werte die letzten Farben bekommen; Werte darüber hinaus sehen ebenso aus"
    ),
    "Percentile": "Perzentil",
    "All but the largest few, so that single spikes do not count": (
        "Alle außer den wenigen größten, sodass einzelne Ausreißer nicht zählen"
    ),
    "Maximum": "Maximum",
    "The largest value": "Der größte Wert",
    "A length of your own, to compare several meshes or bands": (
        "Eine eigene Länge, um mehrere Netze oder Bänder zu vergleichen"
    ),
    "Share of the values within the range: larger makes it wider, and all colors paler": (
        "Anteil der Werte im Bereich: größer macht ihn weiter und alle Farben blasser"
    ),
    "Limit": "Grenze",
    "The value that gets the last color, in scene units: larger makes all colors paler": (
        "Der Wert mit der letzten Farbe, in Einheiten der Szene: größer macht alle Farben blasser"
    ),
    "The angle that gets the last color: larger makes all colors paler": (
        "Der Winkel mit der letzten Farbe: größer macht alle Farben blasser"
    ),
    # Heat map
    "Result": "Ergebnis",
    "Displacement along Normals": "Verschiebung entlang der Normalen",
    "Displacement along normals": "Verschiebung entlang der Normalen",
    "How far each vertex moved along the normal of the result: red outwards, blue inwards": (
        "Wie weit sich jeder Punkt entlang der Normale des Ergebnisses bewegte: rot nach außen, blau nach innen"
    ),
    "Displacement": "Verschiebung",
    "How far each vertex moved, whatever the direction": (
        "Wie weit sich jeder Punkt bewegte, gleich in welcher Richtung"
    ),
    "Angle Change": "Winkeländerung",
    "Angle change of faces": "Winkeländerung der Flächen",
    "By how many degrees each face turned": "Um wie viel Grad sich jede Fläche drehte",
    "How strong the noise was that went, also as the attribute framelet_noise, for nodes and masks": (
        "Wie stark das entfernte Rauschen war, auch als Attribut framelet_noise, für Nodes und Masken"
    ),
    "Noise Width": "Rauschbreite",
    "Noise width in edges": "Rauschbreite in Kanten",
    "How many edges wide it was, also as the attribute framelet_noise_width; 0 if each vertex differs": (
        "Wie viele Kanten breit es war, auch als Attribut framelet_noise_width; 0, wenn jeder Punkt anders ist"
    ),
    "The width that gets the last color, in edge lengths: larger makes all colors paler": (
        "Die Breite mit der letzten Farbe, in Kantenlängen: größer macht alle Farben blasser"
    ),
    "{:.1f}% in this range": "{:.1f} % in diesem Bereich",
    "Green: up to {tolerance}, {share:.3g}%": "Grün: bis {tolerance}, {share:.3g} %",
    "What is at most this far off is green, in scene units: larger makes more green; 0 leaves green out": (
        "Was höchstens so weit abweicht, ist grün, in Szeneneinheiten: größer macht mehr grün; 0 lässt Grün weg"
    ),
    "What is at most this far off is green, in degrees: larger makes more green; 0 leaves green out": (
        "Was höchstens so weit abweicht, ist grün, in Grad: größer macht mehr grün; 0 lässt Grün weg"
    ),
    # Equalizer
    "Equalizer": "Equalizer",
    "Number of scales that have a gain: larger reaches coarser details": (
        "Zahl der Größenstufen mit einem Regler: größer reicht bis zu gröberen Einzelheiten"
    ),
    **{f"Level {level}": f"Stufe {level}" for level in range(1, 7)},
    "Factor for the finest details: larger makes them stronger; 0 removes them, 1 keeps them": (
        "Faktor für die feinsten Einzelheiten: größer macht sie stärker; 0 entfernt sie, 1 behält sie"
    ),
    **{
        f"Factor for details {width} edges wide: larger makes them stronger; 0 removes them, 1 keeps them": (
            f"Faktor für Einzelheiten von {width} Kanten Breite: größer macht sie stärker; 0 entfernt sie, 1 behält sie"
        )
        for width in (2, 4, 8, 16, 32)
    },
    "Vertex Group": "Punktgruppe",
    "Weights of this group scale the change of each vertex; empty changes all alike": (
        "Gewichte dieser Gruppe bemessen die Änderung jedes Punktes; leer ändert alle gleich"
    ),
    "Invert": "Umkehren",
    "Change the vertices outside of the group instead": "Stattdessen die Punkte außerhalb der Gruppe ändern",
}
