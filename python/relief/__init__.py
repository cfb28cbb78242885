"""Virtual things touch the real world that a depth camera sees.

    import relief

    with relief.Pipeline("synthetic:room", scene="scenes/two_cubes.json") as pipeline:
        for step in pipeline:
            print(step.time, step.bodies[0].position)

Metres, seconds, kilograms; x right, y down, z forward from the camera. Arrays of a step are
read-only and show the pipeline's memory: copy what is to outlive the next step.
"""

import atexit as _atexit

from ._relief import *  # noqa: F401,F403
from ._relief import __version__, set_log as _set_log  # noqa: F401

# No line may ask for the interpreter after its end.
_atexit.register(_set_log, None)
