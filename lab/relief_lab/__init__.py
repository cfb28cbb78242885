"""What Relief is worth, measured: sections in Python over `import relief`, the others in C."""
