"""What every part of the window is made with: worker, theme, icons, words."""
