"""``python -m pyfrc``."""

from pyfrc_cli.start import main

if __name__ == "__main__":
    main()
