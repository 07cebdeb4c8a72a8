"""One callback of a widget at a time.

Jupyter may answer two messages of a page in two threads of the kernel (its "subshells"): a widget's
first message in the main thread, the next in another, before the first is done. So a callback that
generates, draws or changes what is on show holds TURN, and the next one waits. It then acts on the
values of that moment, not on those of its message.
"""

import threading

TURN = threading.RLock()  # of all widgets: they share the networks
