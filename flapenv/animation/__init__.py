"""Moving pictures of wingbeats: `flapenv.animate`, and `python -m flapenv.animation` in the terminal."""

from flapenv.animation.film import animate

__all__ = ["animate"]
