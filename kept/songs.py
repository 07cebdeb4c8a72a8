"""All training songs and their Mel frames, by all cores, for train.py."""
import os, pickle, sys, time
from pathlib import Path
from dataclasses import replace
from concurrent.futures import ProcessPoolExecutor
import numpy as np, torch
torch.set_num_threads(1)
from data_synth.music.varied import varied_song
from data_synth.music.recorded import recorded_song
from data_synth.music.composer import SONGS_A_SEED
from motiondiff_edu.conditions.music import log_mel
def one(k):
    song = recorded_song(varied_song(1*SONGS_A_SEED+k, 20.0), 0)
    mel = log_mel(torch.from_numpy(song.audio).float())
    return replace(song, audio=np.zeros(len(song.audio), np.int8)), mel.numpy()
if __name__=="__main__":
    t=time.time(); made=Path(os.environ.get("MADE", "build/made")); made.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(2) as pool:
        out=list(pool.map(one, range(1500), chunksize=10))
    pickle.dump(out, open(made / "songs.pkl","wb")); print(time.time()-t)
