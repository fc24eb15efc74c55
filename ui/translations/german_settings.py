# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German for the settings of a denoising run, and for presets."""

TEXTS = {
    "Research": "Forschung",
    # Presets
    "Preset": "Vorgabe",
    "Framelet Presets": "Framelet-Vorgaben",
    "What the mesh is or which algorithm to use; choosing one sets all values below": (
        "Was für ein Netz es ist oder welcher Algorithmus; eine Wahl setzt alle Werte darunter"
    ),
    "Automatic": "Automatisch",
    "For any noisy mesh: sees how strong the noise is at each place; keeps sharp features": (
        "Für jedes verrauschte Netz: sieht, wie stark das Rauschen an jeder Stelle ist; erhält scharfe Kanten"
    ),
    "Scan (free-form)": "Scan (Freiform)",
    "For scans and organic shapes: takes noise that is several edges wide for noise, too": (
        "Für Scans und organische Formen: hält auch mehrere Kanten breites Rauschen für Rauschen"
    ),
    "CAD (prismatic)": "CAD (prismatisch)",
    "For machine parts and buildings with strong noise: one pass more, for sharper creases": (
        "Für Maschinenteile und Gebäude mit starkem Rauschen: ein Durchgang mehr, für schärfere Kanten"
    ),
    "Marching Cubes / CT": "Marching Cubes / CT",
    "For surfaces made of voxels, as from CT: turns steps into smooth shapes and does not shrink them": (
        "Für Oberflächen aus Voxeln, etwa von CT: macht aus Stufen glatte Formen und schrumpft sie nicht"
    ),
    "Sculpt (keep detail)": "Skulptur (Details behalten)",
    "For sculpted and finely detailed meshes with a little noise: keeps strokes a few edges wide": (
        "Für modellierte und fein gegliederte Netze mit wenig Rauschen: erhält Striche von wenigen Kanten Breite"
    ),
    "Positions": "Positionen",
    "For even, soft smoothing of any mesh: the frame that fits its faces, vector shrinkage": (
        "Für gleichmäßig weiches Glätten jedes Netzes: der Frame, der zu den Flächen passt, Vektor-Schrumpfung"
    ),
    "Paper Tri-1": "Artikel Tri-1",
    "The paper's algorithm for triangles, even and soft: one-ring means, all bands shrunk together": (
        "Der Algorithmus des Artikels für Dreiecke, gleichmäßig und weich: Mittel des Einsrings, alle Bänder "
        "gemeinsam geschrumpft"
    ),
    "Paper Tri-2": "Artikel Tri-2",
    "The paper's algorithm for triangles that keeps edges better: straight pairs, vector shrinkage": (
        "Der Algorithmus des Artikels für Dreiecke, der Kanten besser erhält: gerade Paare, Vektor-Schrumpfung"
    ),
    "Paper Quad-1": "Artikel Quad-1",
    "The paper's algorithm for quads, even and soft: one-ring means, every number shrunk by itself": (
        "Der Algorithmus des Artikels für Vierecke, gleichmäßig und weich: Mittel des Einsrings, jede Zahl einzeln "
        "geschrumpft"
    ),
    "Paper Quad-2": "Artikel Quad-2",
    "The paper's algorithm for quads that keeps edges better: straight pairs, vector shrinkage": (
        "Der Algorithmus des Artikels für Vierecke, der Kanten besser erhält: gerade Paare, Vektor-Schrumpfung"
    ),
    "Bilateral": "Bilateral",
    "The method that the paper compares with: bilateral mesh filtering, five iterations": (
        "Das Verfahren, mit dem der Artikel vergleicht: bilaterales Filtern, fünf Schritte"
    ),
    "Custom": "Eigene",
    "Your own combination": "Ihre eigene Zusammenstellung",
    # Engines
    "Engine": "Verfahren",
    "How the surface is cleaned": "Wie die Oberfläche gereinigt wird",
    "Learned shrinkage: cleans the directions of the faces, then fits the vertices; keeps features": (
        "Gelernte Schrumpfung: reinigt die Richtungen der Flächen und passt die Punkte daran an; erhält Kanten"
    ),
    "Positions (paper)": "Positionen (Artikel)",
    "Split Bregman on vertex positions with a tight wavelet frame": (
        "Split-Bregman-Verfahren auf den Positionen der Punkte mit einem straffen Wavelet-Frame"
    ),
    "Bilateral mesh filtering (Fleishman et al. 2003), the paper's baseline": (
        "Bilaterales Filtern (Fleishman et al. 2003), der Vergleichsmaßstab des Artikels"
    ),
    "Strength": "Stärke",
    "How strong the noise is taken to be, in units of what the mesh shows, or of λ and of the height below: "
    "larger removes more noise and more detail; 1 trusts them, 0 changes nothing": (
        "Für wie stark das Rauschen gehalten wird, in Einheiten dessen, was das Netz zeigt, oder von λ und der "
        "Höhe darunter: größer entfernt mehr Rauschen und mehr Einzelheiten; 1 vertraut ihnen, 0 ändert nichts"
    ),
    "How wide the noise is: fine relief and wide noise look alike, and nobody but you knows which it is": (
        "Wie breit das Rauschen ist: feines Relief und breites Rauschen sehen gleich aus, und nur Sie wissen, was "
        "es ist"
    ),
    "What the mesh shows; fine relief stays where it can be told from noise": (
        "Was das Netz zeigt; feines Relief bleibt, wo es von Rauschen zu unterscheiden ist"
    ),
    "Fine": "Fein",
    "Different from vertex to vertex; what is wider is taken for relief": (
        "Von Punkt zu Punkt verschieden; was breiter ist, gilt als Relief"
    ),
    "Wide": "Breit",
    "Smooth over several edges, or steps of voxels; fine relief goes too": (
        "Über mehrere Kanten glatt, oder Stufen von Voxeln; auch feines Relief verschwindet"
    ),
    "Passes": "Durchgänge",
    "How often the surface is cleaned, each time guided by the result before: larger cleans strong noise on machine "
    "parts better": (
        "Wie oft die Oberfläche gereinigt wird, jedes Mal vom Ergebnis davor geleitet: größer reinigt starkes "
        "Rauschen auf Maschinenteilen besser"
    ),
    "Parameters": "Parameter",
    "Where λ, μ and the number of iterations come from": "Woher λ, μ und die Zahl der Schritte kommen",
    "As Set": "Wie eingestellt",
    "The values that are set": "Die eingestellten Werte",
    "From Noise": "Aus dem Rauschen",
    "From the measured noise, for each mesh its own": "Aus dem gemessenen Rauschen, für jedes Netz eigene",
    # Positions
    "Frame": "Frame",
    "The filter bank of the wavelet frame": "Die Filterbank des Wavelet-Frames",
    "Stencil": "Schablone",
    "Which points fill the masks at irregular vertices; masks wider than 3x3 and those on cells follow the lines of "
    "the mesh instead, except with Adaptive": (
        "Welche Punkte die Masken an irregulären Punkten füllen; Masken über 3x3 und die auf Zellen folgen "
        "stattdessen den Linien des Netzes, außer mit Adaptiv"
    ),
    "Mean": "Mittel",
    "At irregular vertices every tap is the mean of the one-ring; smooths more, blurs edges": (
        "An irregulären Punkten ist jeder Abgriff das Mittel des Einsrings; glättet mehr, verwischt Kanten"
    ),
    "Straight": "Gerade",
    "At irregular vertices neighbors are paired along the straightest lines; keeps edges": (
        "An irregulären Punkten werden Nachbarn entlang der geradesten Linien gepaart; erhält Kanten"
    ),
    "Adaptive": "Adaptiv",
    "Masks fit each vertex's valence, whatever the frame; exactly tight": (
        "Masken passen zur Valenz jedes Punktes, gleich welcher Frame; genau straff"
    ),
    "Shrinkage": "Schrumpfung",
    "What is shrunk together": "Was gemeinsam geschrumpft wird",
    "Each coordinate is shrunk by its norm over all bands (4.5); depends on the axes": (
        "Jede Koordinate wird nach ihrer Norm über alle Bänder geschrumpft (4.5); hängt von den Achsen ab"
    ),
    "Vector": "Vektor",
    "Each band is shrunk by the length of its vector; does not depend on the axes": (
        "Jedes Band wird nach der Länge seines Vektors geschrumpft; hängt nicht von den Achsen ab"
    ),
    "Scalar": "Skalar",
    "Each number is shrunk by itself (5.5); depends on the axes": (
        "Jede Zahl wird für sich geschrumpft (5.5); hängt von den Achsen ab"
    ),
    "Levels": "Stufen",
    "Number of scales: larger also removes coarser noise": (
        "Zahl der Größenstufen: größer entfernt auch gröberes Rauschen"
    ),
    "Smoothing λ": "Glättung λ",
    "Weight of the frame coefficients, in mean edge lengths: larger removes more noise and more detail": (
        "Gewicht der Frame-Koeffizienten, in mittleren Kantenlängen: größer entfernt mehr Rauschen und mehr "
        "Einzelheiten"
    ),
    "Penalty μ": "Kopplung μ",
    "Coupling of surface and coefficients, without unit: larger takes smaller, safer steps and needs more "
    "iterations": (
        "Kopplung von Oberfläche und Koeffizienten, ohne Einheit: größer macht kleinere, sicherere Schritte und "
        "braucht mehr davon"
    ),
    "Feedback δ": "Rückführung δ",
    "Share of the removed detail that comes back at each iteration: larger stays closer to the input": (
        "Anteil des Entfernten, der in jedem Schritt zurückkommt: größer bleibt näher an der Vorlage"
    ),
    "Iterations": "Schritte",
    "Number of iterations: larger comes closer to the minimum, which is smoother, and takes longer": (
        "Zahl der Schritte: größer kommt näher an das Minimum, das glatter ist, und dauert länger"
    ),
    "Tolerance": "Toleranz",
    "Stop early once an iteration moves the vertices by less than this (rms, in mean edge lengths): larger stops "
    "sooner; 0 runs all iterations": (
        "Früher aufhören, sobald ein Schritt die Punkte um weniger bewegt (Effektivwert, in mittleren Kantenlängen): "
        "größer hört eher auf; 0 rechnet alle Schritte"
    ),
    "Boundary": "Rand",
    "What happens at open borders": "Was an offenen Rändern geschieht",
    "Fixed": "Fest",
    "Boundary vertices do not move": "Randpunkte bewegen sich nicht",
    "Along": "Entlang",
    "Boundaries are smoothed along themselves and are not pulled inwards; corners keep their place": (
        "Ränder werden entlang sich selbst geglättet und nicht nach innen gezogen; Ecken bleiben, wo sie sind"
    ),
    "Free": "Frei",
    "Boundary vertices move like all others, so that open borders shrink, but not with Automatic, which "
    "treats them as Along does": (
        "Randpunkte bewegen sich wie alle anderen, sodass offene Ränder schrumpfen, nicht aber mit Automatisch, "
        "das sie wie Entlang behandelt"
    ),
    # Bilateral
    "Neighborhood σc": "Umgebung σc",
    "Bilateral: width of the neighborhood, in mean edge lengths; larger smooths over a wider area": (
        "Bilateral: Breite der Umgebung, in mittleren Kantenlängen; größer glättet über eine weitere Fläche"
    ),
    "Height σs": "Höhe σs",
    "Bilateral: heights up to this are treated as noise, in mean edge lengths; larger smooths over higher features; "
    "0 measures the heights of the mesh": (
        "Bilateral: Höhen bis hierher gelten als Rauschen, in mittleren Kantenlängen; größer glättet höhere Formen; "
        "0 misst die Höhen des Netzes"
    ),
    "Threads": "Threads",
    "Number of threads: larger is faster, up to the number of cores, with the same result; 0 uses all": (
        "Zahl der Threads: größer ist schneller, bis zur Zahl der Kerne, mit demselben Ergebnis; 0 nimmt alle"
    ),
}
