// The way from the editor's page to Python. Each message sends a difference (a frame pinned or
// released, a joint moved by so much since it was gripped) and none sends a pose: the pose on the
// page may be old, and Python adds the difference to its own. So nothing has to wait for an answer.

const SILENCE = 5000;
const PATIENCE = 1000; // milliseconds

// `heard()`: the number of the message that Python answered last; `busy()`: it makes in-betweens.
// `trouble(gone)` is called when no answer comes (false), or no message can be sent any more
// (true).
export function wire(model, heard, busy, trouble) {
  let number = 0;
  let waiting = null;
  let dragged = 0;
  let gone = false;
  let silence = 0;
  let patience = 0;

  function reach(content) {
    // `send` throws once the kernel was shut down or restarted
    try {
      model.send(content);
    } catch {
      gone = true;
      waiting = null;
      close();
      trouble(true);
      return false;
    }
    gone = false;
    return true;
  }

  function send(content) {
    const next = Math.max(number, heard()) + 1;
    if (!reach({ ...content, number: next })) return false;
    number = next;
    clearTimeout(silence);
    silence = setTimeout(miss, SILENCE);
    return true;
  }

  function miss() {
    if (heard() >= number) return;
    if (!busy()) trouble(false);
    else if (reach({ do: "ping" })) silence = setTimeout(miss, SILENCE);
  }

  // One drag at a time is on its way, so that a slow kernel is not flooded; the newest goes next,
  // and holds all that its grip moved. Without an answer it goes all the same.
  function handOn() {
    const content = waiting;
    waiting = null;
    if (!content || !send(content)) return;
    dragged = number;
    clearTimeout(patience);
    patience = setTimeout(() => {
      patience = 0;
      handOn();
    }, PATIENCE);
  }

  function close() {
    clearTimeout(silence);
    clearTimeout(patience);
    patience = 0;
  }

  return {
    close,
    handOn,
    gone: () => gone,
    asking: () => !gone && number > heard(), // a request that is not answered yet
    dragging: () => waiting != null || (!gone && dragged > heard()),
    ask(content) {
      // the number of the message, or 0 where none can be sent; drags go before it
      handOn();
      return send(content) ? number : 0;
    },
    drag(content) {
      waiting = content;
      if (!patience) handOn();
    },
    answered() {
      if (heard() < dragged) return;
      clearTimeout(patience);
      patience = 0;
      handOn();
    },
  };
}
