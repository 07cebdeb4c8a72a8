"""choose.py WEIGHTS out.json: measures of several w and eta on songs that are not judged."""
import sys, json, time, torch
from functools import partial
from dataclasses import dataclass
from tools.results.walks import scores
from tools.results.intervals import interval
scores.interval = partial(interval, draws=50)
from tools.results.dances import parts
from tools.results.dances.parts import Stage, DanceSize, danced, dances, floor_and_genre, LONG
from tools.results.dances.songs import judged_songs, UNSEEN, TRAINED
from motiondiff_edu.pretrained.checkpoints import load_dancer
torch.set_num_threads(2)
SEED = UNSEEN + 40
class Other(Stage):
    from functools import cached_property
    @cached_property
    def songs(self): return judged_songs(self.size.songs, seed=SEED)
    @cached_property
    def pieces(self): return judged_songs(self.size.pieces, self.size.each, TRAINED, seed=SEED+1)
@dataclass
class G:
    dancer: object; w: float; eta: float
    def dance_mel(self, mel, frames, *, generator): return self.dancer.dance_mel(mel, frames, generator=generator, guidance=self.w, eta=self.eta)
stage=Other(DanceSize(songs=24, seeds=1, pieces=10, each=8))
dancer=load_dancer(sys.argv[1])
out={}
for w, eta in ((2,.5),(2.5,.25),(1,.5),(3,.5),(2,.25),(2.5,.5)):
    t=time.time(); f=danced(stage, G(dancer,w,eta)); m={x.name:x.value for x in f.measures}
    out[f"{w},{eta}"]=m
    keys=("bas","bas_data","bas_share","speed_over_data","beats_per_beat_over_data","bone_rmse_cm","skating_mps","multimodality_over_data","diversity","fid")
    print(w,eta,f"{time.time()-t:.0f}s",{k:round(m[k],3) for k in keys if k in m},flush=True)
    json.dump(out,open(sys.argv[2],"w"))
for w,eta in ((2,.5),(2.5,.25)):
    made=dances(stage, G(dancer,w,eta), 400, 1)[0]
    print(w,eta,{x.name:round(x.value,3) for x in floor_and_genre(stage, made)},flush=True)
