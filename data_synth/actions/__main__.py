"""`python -m data_synth.actions --out FOLDER`: as `python -m data_synth actions`."""

from .write import main

if __name__ == "__main__":
    main()
