# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German for measurements and reports in the sidebar."""

TEXTS = {
    "The object is gone": "Das Objekt ist nicht mehr da",
    "The mesh has too many vertices for a preview; press Denoise": (
        "Das Netz hat zu viele Punkte für eine Vorschau; drücken Sie Entrauschen"
    ),
    "Framelet": "Framelet",
    "Advanced": "Erweitert",
    "Last Run": "Letzter Lauf",
    "Noise": "Rauschen",
    "Sample Data": "Beispieldaten",
    "Learned, on face normals": "Gelernt, auf Flächennormalen",
    "None, fitted at once": "Keiner, Punkte direkt angepasst",
    "By local noise": "Nach dem Rauschen an jeder Stelle",
    # What a run took for noise
    "Strength is 0": "Stärke ist 0",
    "Clean already": "Schon sauber",
    "{low} to {high}": "{low} bis {high}",
    "{range} edges": "{range} Kanten",
    "Width": "Breite",
    "about {:.1f} edges": "etwa {:.1f} Kanten",
    "Along Surface": "Entlang der Fläche",
    "{:.2g} edges": "{:.2g} Kanten",
    "Share of the faces whose noise was taken for wide, as neighbors share it": (
        "Anteil der Flächen, deren Rauschen für breites gehalten wurde, da Nachbarn es teilen"
    ),
    "What was taken away along the surface, root mean square in edge lengths": (
        "Was entlang der Fläche weggenommen wurde, quadratisches Mittel in Kantenlängen"
    ),
    "Spikes": "Ausreißer",
    "Clean": "Sauber",
    "{:.3g}% stayed": "{:.3g} % blieben",
    "Removed": "Entfernt",
    "The noise is what automatic denoising took away, not an estimate": (
        "Das Rauschen ist, was das automatische Entrauschen wegnahm, keine Schätzung"
    ),
    "Off": "Aus",
    "Strength was 0, so that nothing moved": "Die Stärke war 0, sodass sich nichts bewegte",
    "Clean Already": "Schon sauber",
    "There was no noise, and nothing moved": "Es gab kein Rauschen, und nichts bewegte sich",
    "Quietest": "Am ruhigsten",
    "Strongest": "Am stärksten",
    "Quietest in Edge Lengths": "Am ruhigsten, in Kantenlängen",
    "Strongest in Edge Lengths": "Am stärksten, in Kantenlängen",
    "Strength of the noise in its quietest tenth of the surface, in scene units": (
        "Stärke des Rauschens im ruhigsten Zehntel der Oberfläche, in Einheiten der Szene"
    ),
    "Strength of the noise in its strongest tenth of the surface, in scene units": (
        "Stärke des Rauschens im stärksten Zehntel der Oberfläche, in Einheiten der Szene"
    ),
    "Strength of the noise in its quietest tenth of the surface, in mean edge lengths": (
        "Stärke des Rauschens im ruhigsten Zehntel der Oberfläche, in mittleren Kantenlängen"
    ),
    "Strength of the noise in its strongest tenth of the surface, in mean edge lengths": (
        "Stärke des Rauschens im stärksten Zehntel der Oberfläche, in mittleren Kantenlängen"
    ),
    "Standard deviation of what smoothed the noise, in edge lengths; 0 if nothing did": (
        "Standardabweichung dessen, was das Rauschen glättete, in Kantenlängen; 0, wenn es nichts tat"
    ),
    "Share of the vertices that were far off alone": "Anteil der Punkte, die allein weit ab lagen",
    "Share of the vertices that were clean, and stayed": "Anteil der Punkte, die sauber waren und blieben",
    "What the last run took from the noise of this object; empty for nothing": (
        "Was der letzte Lauf aus dem Rauschen dieses Objekts nahm; leer, wenn nichts"
    ),
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
    "Frame That Ran": "Verwendeter Frame",
    "Name of the frame that ran, also where the mesh decided; empty if there was none or objects had different "
    "ones": (
        "Name des Frames, der verwendet wurde, auch wo das Netz entschied; leer, wenn es keinen gab oder die Objekte "
        "verschiedene hatten"
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
    "The objects that are colored; none if empty": "Die gefärbten Objekte; leer, wenn es keine gibt",
    "What is shown": "Was zu sehen ist",
    "Quantity": "Größe",
    "What a heat map shows; empty for bands": "Was ein Wärmebild zeigt; leer bei Bändern",
    "Signed": "Mit Vorzeichen",
    "Values are components along the normals": "Werte sind Anteile entlang der Normalen",
    "Unit": "Einheit",
    "LENGTH in scene units, ANGLE in degrees, or EDGES in mean edge lengths": (
        "LENGTH in Einheiten der Szene, ANGLE in Grad oder EDGES in mittleren Kantenlängen"
    ),
    "Minimum": "Minimum",
    "The value with the first color, in scene units, degrees or edge lengths": (
        "Der Wert mit der ersten Farbe, in Einheiten der Szene, Grad oder Kantenlängen"
    ),
    "The value with the last color, in scene units, degrees or edge lengths": (
        "Der Wert mit der letzten Farbe, in Einheiten der Szene, Grad oder Kantenlängen"
    ),
    "Largest magnitude of all values, in scene units, degrees or edge lengths": (
        "Größter Betrag aller Werte, in Einheiten der Szene, Grad oder Kantenlängen"
    ),
    "Share of the vertices within the range": "Anteil der Punkte im Bereich",
    "Shading": "Schattierung",
    "How the 3D View was shaded before": "Wie die 3D-Ansicht vorher schattiert war",
    "Color": "Farbe",
    "What colored the 3D View before": "Was die 3D-Ansicht vorher färbte",
}
