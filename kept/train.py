"""Train a recipe of a dancer from songs and dances that all cores have made before.

    python kept/songs.py; python kept/train.py data; python kept/train.py dancer

The same data as `python -m motiondiff_edu.recipes dancer` makes on one core. The ear is that of
kept/ear.safetensors where its own run is not there. MADE names the folder of all files.
"""
import pickle, sys, os, time, shutil
from dataclasses import replace
from pathlib import Path
from concurrent.futures import ProcessPoolExecutor
import numpy as np, torch
torch.set_num_threads(int(os.environ.get("OMP_NUM_THREADS","1")))
from motiondiff_edu.conditions.music import frame_times
from motiondiff_edu.beyond.hearing import counts
from motiondiff_edu.performers.ear import GENRES
from motiondiff_edu.recipes.songs import HeardSongs
from motiondiff_edu.recipes import ear as E, train_dancer as T, __main__ as M
from motiondiff_edu.recipes.dancers import DANCE_RECIPES
from motiondiff_edu.performers.dance_windows import DanceWindows
from motiondiff_edu.pretrained.checkpoints import save
from data_synth.dancing.performance import dance, DANCES_A_SEED
MADE = Path(os.environ.get("MADE", "build/made"))

def kept_ear(recipe, run_file, log=print):
    """The ear whose weights were kept, if it was made by this recipe."""
    from dataclasses import asdict
    import json
    from safetensors import safe_open
    with safe_open(Path(__file__).with_name("ear.safetensors"), "pt") as f:
        about = json.loads(f.metadata()["about"])
        weights = {k: f.get_tensor(k).float() for k in f.keys()}
    wanted = json.loads(json.dumps(asdict(recipe.ear)))
    assert {k: about[k] for k in wanted} == wanted, "another recipe"
    ear = E.Ear(recipe.ear.config)
    ear.load_state_dict(weights)
    return ear

def load(): return pickle.load(open(MADE / "songs.pkl","rb"))
def danced(args):
    k, song = args
    return [(d.positions.astype(np.float32), d.contacts) for d in (dance(song, DANCES_A_SEED+2*k+j) for j in range(2))]
def heard(made):
    mels=[torch.from_numpy(m) for _,m in made]
    told=[counts(frame_times(len(m)).numpy(), s.beats, s.bar_position, s.metre) for (s,_),m in zip(made,mels)]
    return HeardSongs.told(mels,told,[(s.tempo, GENRES.index(s.genre)) for s,_ in made])
if __name__=="__main__":
    name=sys.argv[1]; made=load(); t=time.time()
    cache=MADE / "dances.pkl"
    if not cache.exists():
        slim=[(k, s) for k,(s,_) in enumerate(made)]
        with ProcessPoolExecutor(2) as pool: out=list(pool.map(danced, slim, chunksize=20))
        pickle.dump(out, open(cache,"wb")); print("dances", time.time()-t, flush=True)
    if name=="data": sys.exit()
    out=pickle.load(open(cache,"rb"))
    pos=[];con=[];mels=[]
    for (s,m),two in zip(made,out):
        m=torch.from_numpy(m)
        for p,c in two: pos.append(p);con.append(c);mels.append(m)
    songs=heard(made); E.songs_of=lambda *a: songs
    if not list(MADE.glob("ear-*.run.safetensors")): T.ear_of=kept_ear
    windows=DanceWindows.of(pos,con,mels,100); print(len(windows), flush=True)
    del made,out,pos
    recipe=DANCE_RECIPES[name]
    if len(sys.argv)>2: recipe=replace(recipe, steps=int(sys.argv[2]))
    dancer=T.train_dancer(recipe, MADE / f"{name}.run.safetensors", windows, log=lambda s: print(s,flush=True))
    save(dancer, MADE / f"{name}.safetensors", bits=16); print("done")
