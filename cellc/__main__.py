"""``python -m cellc`` is the command ``cellc``."""

from cellc.cli.main import main

if __name__ == "__main__":
    main()
