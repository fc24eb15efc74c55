# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""List the texts that a translation misses, and its entries that belong to no text.

make translations
"""

import conftest  # noqa: F401


def main() -> None:
    """Print both lists for each language."""
    import framelet
    from framelet.ui import translations

    framelet.register()
    try:
        import translatable

        shown = translatable.messages()
        for language, entries in translations.TRANSLATIONS.items():
            _print(f"{language}: texts without an entry", shown - set(entries))
            _print(f"{language}: entries without a text", set(entries) - shown)
    finally:
        # An operator that is registered when Python exits hangs some versions of Blender.
        framelet.unregister()


def _print(title: str, texts: set[tuple[str, str]]) -> None:
    """Print a list with its length."""
    print(f"{title} ({len(texts)})")
    for context, text in sorted(texts):
        print(f"  {context}: {text!r}")


if __name__ == "__main__":
    main()
