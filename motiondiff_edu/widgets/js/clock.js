// The clock of the player: the sound if there is one, else the page's own clock. Seconds from the
// motion's start. A clock has start(), stop(), seek(seconds), rate(factor) and now().

export function silentClock(length, visible) {
  // stands still while the figure is out of sight
  let at = 0;
  let before = 0;
  let factor = 1;
  let going = false;
  return {
    start() {
      before = performance.now();
      going = true;
    },
    stop() {
      going = false;
    },
    seek(seconds) {
      at = seconds;
      before = performance.now();
    },
    rate(value) {
      factor = value;
    },
    now() {
      const time = performance.now();
      if (going && visible()) at = (at + Math.min(0.5, (time - before) / 1000) * factor) % length;
      before = time;
      return at;
    },
  };
}

// The sound's own time moves in steps, coarse ones in some browsers, and starts late. Between two
// readings the page's clock runs on, by no more than the longest step seen so far (60 ms at first);
// a new reading puts it right. A reading may be late but not early: one that is ahead is taken as
// it is, one a little behind is approached. When the sound stutters, the reported time never goes
// back: the picture waits for the sound. A jump, the loop and a stall are taken at once.
const FAR = 0.06;
const STALLED = 0.3;
const PULL = 0.1;

export function soundClock(audio) {
  let heard = audio.currentTime;
  let at = heard;
  let told = heard;
  let lead = FAR;
  let before = 0;
  let fresh = 0;
  let waiting = true;
  const hold = () => {
    heard = at = told = audio.currentTime;
    waiting = true;
    return told;
  };
  return {
    start() {
      hold();
      return audio.play();
    },
    stop() {
      audio.pause();
      hold();
    },
    seek(seconds) {
      audio.currentTime = seconds;
      hold();
    },
    rate(value) {
      audio.preservesPitch = true;
      audio.defaultPlaybackRate = audio.playbackRate = value;
      hold();
    },
    now() {
      if (audio.paused || audio.seeking) return hold();
      const time = performance.now() / 1000;
      const reading = audio.currentTime;
      const step = reading - heard;
      if (waiting) {
        hold();
        waiting = step === 0;
        before = fresh = time;
        return told;
      }
      const stalled = step === 0 && time - fresh > STALLED && told - reading > FAR;
      if (stalled || step < -FAR) return hold();
      const passed = (time - before) * audio.playbackRate;
      at = Math.min(at + passed, heard + lead);
      if (step !== 0) {
        if (step < STALLED * audio.playbackRate) lead = Math.max(lead, step - passed);
        const off = reading - at;
        at = off > 0 || off < -FAR ? reading : at + PULL * off;
        heard = reading;
        fresh = time;
      }
      before = time;
      told = Math.max(told, at);
      return told;
    },
  };
}

// An <audio> element that plays bytes from memory, by an address the page has for them, or spelled
// out where a page forbids that; `fail` is called when neither can be played. Returns what frees
// the address.
export function feed(audio, view, mime, fail) {
  const blob = new Blob([view], { type: mime });
  const address = URL.createObjectURL(blob);
  audio.loop = true;
  audio.onerror = () => {
    audio.onerror = fail;
    if (audio.currentTime > 0) return fail(); // it played, then broke off
    const reader = new FileReader();
    reader.onload = () => {
      audio.src = reader.result;
    };
    reader.readAsDataURL(blob);
  };
  audio.src = address;
  return () => {
    audio.onerror = null;
    audio.pause();
    audio.removeAttribute("src");
    audio.load();
    URL.revokeObjectURL(address);
  };
}
