# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German for measurements and reports in the sidebar."""

TEXTS = {
    "Framelet": "Framelet",
    "Advanced": "Erweitert",
    "Last Run": "Letzter Lauf",
    "Noise": "Rauschen",
    "Try It": "Ausprobieren",
    # What a run chose
    "Chosen": "Gewählt",
    "At the next run": "Beim nächsten Lauf",
    "What the last run chose for this object; empty if it chose nothing": (
        "Was der letzte Lauf für dieses Objekt wählte; leer, wenn er nichts wählte"
    ),
    "Flat and sharp": "Flach und scharf",
    "Smooth and even": "Glatt und gleichmäßig",
    "Sharp and coarse": "Scharf und grob",
    "Fine relief": "Feines Relief",
    "after smoothing 4": "nach Glättung 4",
    "after smoothing 8": "nach Glättung 8",
    "after smoothing 16": "nach Glättung 16",
    "Soft relief": "Weiches Relief",
    "Soft relief after smoothing 8": "Weiches Relief nach Glättung 8",
    "Soft and coarse 32": "Weich und grob 32",
    **{f"Crisp edges {n}": f"Klare Kanten {n}" for n in (16, 32)},
    **{f"Crisp edges {n} after smoothing 4": f"Klare Kanten {n} nach Glättung 4" for n in (16, 32)},
    "Flat and sharp after smoothing 4": "Flach und scharf nach Glättung 4",
    "Sharp and coarse after smoothing 4": "Scharf und grob nach Glättung 4",
    **{f"Smooth and even after smoothing {n}": f"Glatt und gleichmäßig nach Glättung {n}" for n in (4, 16)},
    **{f"Fine relief after smoothing {n}": f"Feines Relief nach Glättung {n}" for n in (8, 16)},
    **{f"Smooth and coarse {number}": f"Glatt und grob {number}" for number in (24, 32, 128, 192)},
    "refined": "verfeinert",
    "half refined": "halb verfeinert",
    "refined finely": "fein verfeinert",
    "half refined finely": "halb fein verfeinert",
    "refined twice": "zweimal verfeinert",
    "half refined twice": "halb zweimal verfeinert",
    "in place": "am Ort",
    "half in place": "halb am Ort",
    "Clean already": "Schon sauber",
    "Low-pass": "Tiefpass",
    "Pairwise (normals)": "Paarweise (Normalen)",
    "Bilateral (normals)": "Bilateral (Normalen)",
    "Bands (positions)": "Bänder (Positionen)",
    "{number} averages": "{number} Mittelungen",
    "{number} × noise": "{number} × Rauschen",
    # Tables
    "Nothing was denoised yet": "Noch nichts entrauscht",
    "Object": "Objekt",
    "Objects": "Objekte",
    "Vertices": "Punkte",
    "Moved": "Bewegt",
    "{:,} of {:,}": "{:,} von {:,}",
    "{:.3f} edge lengths": "{:.3f} Kantenlängen",
    "RMS": "Effektivwert",
    "Largest": "Größte",
    "Volume": "Volumen",
    "Open mesh": "Offenes Netz",
    "Flipped Faces": "Umgeklappt",
    "Irregular": "Irregulär",
    "Non-Manifold": "Verzweigt",
    "Loose": "Lose",
    "Impulsive": "Mit Ausreißern",
    "Time": "Zeit",
    "Noise Before": "Rauschen vorher",
    "Against": "Gegen",
    "Mean Angle": "Mittlerer Winkel",
    "Largest Angle": "Größter Winkel",
    # Properties that hold them
    "In Edge Lengths": "In Kantenlängen",
    "Standard deviation of the noise along the normals, in scene units": (
        "Standardabweichung des Rauschens entlang der Normalen, in Einheiten der Szene"
    ),
    "Standard deviation of the noise along the normals, in mean edge lengths": (
        "Standardabweichung des Rauschens entlang der Normalen, in mittleren Kantenlängen"
    ),
    "Standard deviation of the noise along the normals, in scene units, root mean square over all vertices": (
        "Standardabweichung des Rauschens entlang der Normalen, in Einheiten der Szene, Effektivwert über alle Punkte"
    ),
    "Some vertices are displaced much more than others; the noise is that of the quieter ones": (
        "Manche Punkte sind viel weiter verschoben als andere; das Rauschen ist das der ruhigeren"
    ),
    "Of any object: some vertices are displaced much more than others; the noise is that of the quieter ones": (
        "Bei irgendeinem Objekt: manche Punkte sind viel weiter verschoben als andere; das Rauschen ist das der "
        "ruhigeren"
    ),
    "Denoised": "Entrauscht",
    "The noise is that before the last run, which removed it": (
        "Das Rauschen ist das vor dem letzten Lauf, der es entfernte"
    ),
    "Recipe": "Rezept",
    "What automatic denoising chose; empty if it did not run": (
        "Was das automatische Entrauschen wählte; leer, wenn es nicht lief"
    ),
    "What automatic denoising chose, separated by semicolons if objects differ": (
        "Was das automatische Entrauschen wählte, durch Semikola getrennt, wenn Objekte sich unterscheiden"
    ),
    "The noise by object": "Das Rauschen je Objekt",
    "The objects that were denoised, separated by commas": "Die entrauschten Objekte, durch Kommas getrennt",
    "Number of objects; 0 before the first run": "Zahl der Objekte; 0 vor dem ersten Lauf",
    "Number of vertices, those that stayed included": "Zahl der Punkte, auch derer, die blieben",
    "Number of vertices that moved": "Zahl der Punkte, die sich bewegten",
    "Iterations that ran, the largest number of any object": (
        "Gerechnete Schritte, die größte Zahl irgendeines Objekts"
    ),
    "Largest Displacement": "Größte Verschiebung",
    "Root mean square over all vertices, in scene units": "Effektivwert über alle Punkte, in Einheiten der Szene",
    "Root mean square over all vertices, in mean edge lengths": (
        "Effektivwert über alle Punkte, in mittleren Kantenlängen"
    ),
    "How far the farthest vertex moved, in scene units": (
        "Wie weit sich der am weitesten bewegte Punkt bewegte, in Einheiten der Szene"
    ),
    "How far the farthest vertex moved, in mean edge lengths": (
        "Wie weit sich der am weitesten bewegte Punkt bewegte, in mittleren Kantenlängen"
    ),
    "Faces that turned by more than a right angle": "Flächen, die sich um mehr als einen rechten Winkel drehten",
    "Closed": "Geschlossen",
    "All meshes are closed, so that their volumes are known": (
        "Alle Netze sind geschlossen, sodass ihre Volumen bekannt sind"
    ),
    "Change of the volume, the largest of any closed mesh": (
        "Änderung des Volumens, die größte irgendeines geschlossenen Netzes"
    ),
    "Vertices that took the irregular rule": "Punkte, für die die Regel für irreguläre galt",
    "Vertices on open borders": "Punkte an offenen Rändern",
    "Vertices where the surface branches": "Punkte, an denen sich die Oberfläche verzweigt",
    "Vertices without a face; they do not move": "Punkte ohne Fläche; sie bewegen sich nicht",
    "Noise Is Known": "Rauschen bekannt",
    "The noise of all objects was measured": "Das Rauschen aller Objekte wurde gemessen",
    "What was taken from the measured noise; empty if nothing was": (
        "Was aus dem gemessenen Rauschen genommen wurde; leer, wenn nichts"
    ),
    "Seconds for all objects": "Sekunden für alle Objekte",
    "The object that was compared; empty before the first time": (
        "Das verglichene Objekt; leer vor dem ersten Mal"
    ),
    "The object it was compared with": "Das Objekt, mit dem verglichen wurde",
    "Mean angle of face normals, in degrees": "Mittlerer Winkel der Flächennormalen, in Grad",
    "Largest angle of face normals, in degrees": "Größter Winkel der Flächennormalen, in Grad",
    "Distance": "Abstand",
    "Largest Distance": "Größter Abstand",
    "Root mean square of the distances of vertices, in scene units": (
        "Effektivwert der Abstände der Punkte, in Einheiten der Szene"
    ),
    "Root mean square of the distances, in mean edge lengths": (
        "Effektivwert der Abstände, in mittleren Kantenlängen"
    ),
    "Largest distance of two vertices, in scene units": "Größter Abstand zweier Punkte, in Einheiten der Szene",
    "Largest distance, in mean edge lengths": "Größter Abstand, in mittleren Kantenlängen",
    "Faces that differ by more than a right angle": (
        "Flächen, die sich um mehr als einen rechten Winkel unterscheiden"
    ),
    # What colors mean
    "The objects that are colored; empty if there are none": "Die gefärbten Objekte; leer, wenn es keine gibt",
    "What is shown": "Was zu sehen ist",
    "Quantity": "Größe",
    "What a heat map shows; empty for bands": "Was ein Wärmebild zeigt; leer bei Bändern",
    "Signed": "Mit Vorzeichen",
    "Values are components along the normals": "Werte sind Anteile entlang der Normalen",
    "Angle": "Winkel",
    "Values are angles in degrees instead of lengths": "Werte sind Winkel in Grad statt Längen",
    "Minimum": "Minimum",
    "The value with the first color, in scene units, or in degrees for angles": (
        "Der Wert mit der ersten Farbe, in Einheiten der Szene, bei Winkeln in Grad"
    ),
    "The value with the last color, in scene units, or in degrees for angles": (
        "Der Wert mit der letzten Farbe, in Einheiten der Szene, bei Winkeln in Grad"
    ),
    "Largest magnitude of all values, in scene units, or in degrees for angles": (
        "Größter Betrag aller Werte, in Einheiten der Szene, bei Winkeln in Grad"
    ),
    "Share of the vertices within the range": "Anteil der Punkte im Bereich",
    "Shading": "Schattierung",
    "How the 3D View was shaded before": "Wie die 3D-Ansicht vorher schattiert war",
    "Color": "Farbe",
    "What colored the 3D View before": "Was die 3D-Ansicht vorher färbte",
}
