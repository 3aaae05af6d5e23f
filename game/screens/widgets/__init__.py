"""The building blocks of all screens: drawing, maps, the bar, dialogs, colours."""
