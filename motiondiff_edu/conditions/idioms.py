"""How people say it: turns of phrase that are rewritten before a sentence is read, and word lists.

    "gets back on their feet" -> rise      "with both arms in the air" -> & hold-s
A new way to say something is a line here. No word was chosen by looking at sentences for judging.
"""

import re

from .acts import ONE
from .text import PASSED_OVER

WHO = (
    r"(?:he|she|they|it|(?:the|a|an) "
    r"(?:man|woman|person|figure|character|guy|lady|boy|girl|robot|actor|dancer))"
)
OWN = r"(?:(?:both|the|his|her|their|your|my|its|one's|a|one|two) )*"  # before a part of the body
# what is rewritten before anything is read; | comes between acts in a row, & between acts at once
REWRITTEN = tuple(
    (re.compile(pattern.replace("{own}", OWN).replace("{who}", WHO)), other)
    for pattern, other in (
        # how words are written
        (r"\bw(/|\b)(?=\w| )", "with "),
        (r"\b(l|lft)\b(?= \w)", "left"),
        (r"\b(r|rt)\b(?= \w)", "right"),
        (r"\bfwd\b", "forward"),
        (r"\band than\b", "and then"),
        (r"\b(left|right)[- ](hand|arm|foot|leg)ed\b", r"\1 \2"),
        (r"\b(left|right)wards?\b", r"to the \1"),
        (r"\blower(s|ing)? (him|her|your|my|them)sel(f|ves) (down )?(in|on)?to {own}\w+", " sit "),
        (r"\bkeep(s|ing)? (on )?going\b", " keep-going "),
        # what says nothing, and what must not be done
        (r"\bgoing to (?!{own}(left|right|door|front|back|side|end)\b)(?!the|an?\b)", " "),
        (r"\b(don't|dont|do not|doesn't|does not) move( at all)?\b", " stand "),
        (r"\b(not|without) moving\b", " "),
        (r"\b(can't|cannot|can not|won't|doesn't|never) stop (?=\w+ing\b)", " "),
        (
            r"\b(instead of|rather than|no|not|cannot|can't|won't|refuses to) "
            r"(?!more|longer|one)\w+"
            r"(?<!ly)(?<!too)(?<!hurry)(?<!rush)\b",
            " not-done ",
        ),
        (r"\bwithout {own}(arms?|hands?)( \w+)?", " not-done "),
        (r"\b(don't|dont|do not|doesn't|does not|never|didn't) \w+", " not-done "),
        (r"\b(in|as an?) greeting\b|\ball the way\b|\bthe (whole|entire) (time|way)\b", " "),
        (r"\b(in|from) {own}(seated|sitting) position\b", " "),
        (
            r"\b(show|animate|generate|create|make|need)( me)?( an?)?( animation)?( of)? "
            r"(?={who}\b)",
            " ",
        ),
        (r"\bas (if|though)( to)?\b", " "),
        (r"\b(to|from|on) the (far |other )?side of {own}\w+", " "),
        (r",? \bas {who} (goes|go|moves|does so|do so|walks along)\b", " "),
        (
            r"\b(and |then )*(lower(s|ed|ing)?( {own}(left |right )?(arms?|hands?)| it| them)?|"
            r"(drop|put)(s|ping|ting)? (back )?"
            r"({own}(left |right )?(arms?|hands?)|it|them) (back )?down)"
            r"( back)?( down)?( again)?\b",
            " | ",
        ),
        (r"\b(\d+|one|two|three|four|five|ten) (s|secs?|seconds?|minutes?)\b", " so-long "),
        (r"\b(for )?(a few|several|some|a couple of) (secs|seconds|moments)\b|\bin a row\b", " "),
        (r"(^|[|,] *){own}(left |right )?(arms?|hands?) (back )?down\b", r"\1 "),
        # a posture at the beginning
        (
            r"^((?:[\w']+ ){0,5}?)(?:is |are |was )?(?:seated|sitting|sat)(?: down)?\b"
            r"(?=.*\b(?:ris(?:e|es|ing)|(?:get|stand|got|stood)\w* (?:back )?(?:up|to|on)))",
            r"\1 ",
        ),
        # order, and at once
        (r"\bprior to\b", " before "),
        (r"\bhaving( first| already| just)?\b(?= \w+ed\b)", " after "),
        (r"\bonce {who}('s|'ve| is| has| have)? (finished|done)( with)?\b", " after "),
        (r"\bonce (?={who}\b)", " after "),
        (r"\band after (?={who}\b)", " | "),
        (r"^[ |]*(simultaneously|at the same time)[ |,]+(.*?) *(, and|,|\band\b)", r"\2 & "),
        (r"^([^|]*)\b(and)\b([^|]*)\b(at the same time|simultaneously)\b", r"\1 & \3"),
        (r"\b(and )?without (stopping|pausing|a break)\b", " & "),
        (r"\bwithout \w+ing\b", " "),
        (r"^(\w+ing\b[^,|&]*), *(?={who}\b(?! then))", r"\1 & "),
        (r"\b(but|and) (first|before (that|this|it))\b,?", " before-it "),
        (r"\bbefore (that|this|it)\b,?", " before-it "),
        (
            r"\b(show|give) (me|us)\b|\blet('s| us)( see)?\b|"
            r"\bi (want|would like|'d like)( to see)?\b",
            " ",
        ),
        (r"\bthe (first|last|next) thing( that)? (he|she|it|they) (does?|do) is( to)?\b", " | "),
        (
            r"\b(no,? )?wait,? no\b|\bno,? wait\b|\bi mean\b|\bscratch that\b|\bor rather\b",
            " i-mean ",
        ),
        (
            r"\bfirst(ly)?\b,?|\bto (start|begin) with\b,?|"
            r"\b(start|begin)(s|ing|ning)?( off| out)?( by| with| to)?\b",
            " ",
        ),
        (r"\b(keep|continue)s?( on)?( to)? (?=\w+ing\b|walk|run)", " is "),
        (
            r"\b(slow|break|speed|chang|transition|switch|mov|go|com)(e?s|ing|e)?( down| up)? "
            r"(in)?to (a |an )?(slow |quick )?(?=(walk|run|jog|sprint|stop|halt|standstill)\b)",
            r" | \6",
        ),
        (r"\b(speed|power)[- ]?walk(s|ing)?\b", " walk quickly "),
        (r"\b(shadow[- ]?)?boxing\b", " punch some-times "),
        (
            r"\bover and over( again)?\b|\bagain and again\b|\brepeatedly\b|\bup and down\b|"
            r"\b(continuously|constantly|non-?stop)\b",
            " some-times ",
        ),
        (r"\b(a )?(series|set|number|bunch|flurry|lot|round|string) of\b", " several "),
        (
            r"\b(hop|jump|skip)(s|ping|ing)? (around|along|about|across|away)\b",
            r" \1\2 some-times ",
        ),
        (r"\bbounc(e|es|ing)\b", " jump some-times "),
        (r"\b(shadow[- ]?)?boxes\b", " punches some-times "),
        (
            r"\b(jump|leap|spring|hop|get|stand)(s|ing)? (right |quickly )?up from "
            r"(sitting|{own}(chair|seat|stool|bench))\b",
            " rise ",
        ),
        (
            r"\b(fac|turn|look)(es?|s|ing|e)? {own}(other|opposite) (way|direction)\b",
            " turn around ",
        ),
        (r"\bturn(s|ing)? about\b", " turn around "),
        (r"\bin no (hurry|rush)( at all)?\b|\b(at a crawl|in slow motion)\b", " slowly "),
        (r"\bspeed(s|ing)? up( and)?\b|\bat (full|top|high) speed\b", " quickly "),
        (r"\b(plop|flop|plonk)(s|ped|ping)? down\b", " sit "),
        (r"^\W*reverses?\b", " walk backwards "),
        (r"\bflag(s|ging)? down\b", " wave "),
        (r"\b(left|right) cross\b", r"\1 punch"),
        (r"\bside[- ]?kick(s|ing)?\b", r"kick\1 sideways"),
        (r"\bstop(s|ped|ping)? \w+ing\b", " stand "),
        (
            r"\bsquat(s|ting)?( down)? (and|then) (come|get|go|stand)(s|ing)? (back )?up\b",
            " squat ",
        ),
        (r"\bcrab[- ]?walk(s|ing)?\b", " step sideways "),
        (r"\bthrow(s|ing)? a (left|right)\b(?! (arm|leg|hand))", r" punch \2 "),
        (r"(?<!in a )\bhurr(y|ies|ying)\b", " walk quickly "),
        (r"\bpaces\b(?= (forward|back|around|up|about|across))", " walks "),
        (
            r"\b(arms?|hands?) (go|goes|come|comes|shoots?|fly|flies) (straight |all the way )?"
            r"up\b",
            r" raise \1 ",
        ),
        (r"\bback and forth\b|\bto and fro\b", " back-and-forth "),
        (
            r"\bon (just |only )?(one|a single|his|her|their|the (left|right)) (leg|foot)\b",
            " on-one-leg ",
        ),
        (
            r"\b(straighten|come|push)(s|ing)? (back |right )?up( again| straight| tall)?\b(?! to)",
            " rise ",
        ),
        (r"\bstraighten(s|ing)?( {own}(back|body|self))?( out)?\b", " rise "),
        (
            r"\b(and |then )*(do(es|ing)?|repeat(s|ing)?) (it|that|this|the same( thing)?)"
            r"( all)?( (over )?again| once more| one more time)*\b|"
            r"\b(and |then )*repeat(s|ing)?\b|\b(and |then )*(the )?same( again)? (?=with|on)",
            " | again-it ",
        ),
        (r"\bone more time\b|\bonce (more|again)\b|\banother time\b", " again "),
        (
            r"\b(reach|stretch)(es|ing)? (up |out )*(high |tall )*(for|to|toward|towards) the "
            r"(sky|ceiling|stars|sun)\b|\b(reach|stretch)(es|ing)? (up|high|tall)\b",
            " stretch up ",
        ),
        (
            r"\b(with )?(each|alternating|alternate) {own}(arms?|hands?|legs?|foot|feet|fists?)\b",
            r" both \3 ",
        ),
        (r"\bin a (hurry|rush)\b", " quickly "),
        (r"\blike\b(?! an?\b)|\bhow about\b|\bfor a (moment|while|second|bit)\b", " "),
        (r"\b(ends?|finish(es)?) (up )?(by|with)\b", " | "),
        (r"\b(and|but|,)?\s*(then|next|afterwards?|later|subsequently|finally|lastly)\b,?", " | "),
        (r"\b(and )?(after|following) (that|this|which|it)\b,?", " | "),
        (r"\bat (the )?(very )?end\b|\bin the end\b", " | "),
        (r"\b(which is |and is |is )?followed by\b|\buntil\b", " | "),
        (
            r"\bat the same time\b,?( as\b)?|\bsimultaneously\b|\ball the while\b|\bmeanwhile\b",
            " & ",
        ),
        (r"\bwhile|\bwhilst\b|\bas (?=(he|she|it|they|the|a|you|i)\b)|\bduring\b", " & "),
        (r"\b(a couple of|a pair of|couple of|double)\b", " twice "),
        (r"\b(a few|several|some|multiple|many) times\b", " some-times "),
        (r"\b(\d+)\s*(x|times)\b|\bx\s*(\d+)\b", r" \1\3 times "),
        (r"\bon {own}(spot|place)\b|\bin place\b", " on-the-spot "),
        (
            r"\b((turn|spin|rotate)(s|ing)? )?"
            r"(half (a )?turn|half[- ]?way (a)?round|(by )?180( degrees?)?)\b|"
            r"\babout[- ](face|turn)\b|\bu[- ]turn\b",
            " turn around ",
        ),
        (r"\bhalf round\b", " around "),
        (r"\b(stands?|standing) (up |very )?straight\b(?! up)", " stand "),
        (
            r"\b(stands?|standing|stood|gets?|getting|got|gat) (right |straight )?(back )?up\b",
            " rise ",
        ),
        (r"\b(gets?|getting) (back )?(on|to) {own}feet\b", " rise "),
        (r"\b(go|come|get)(es|s|ing)? (back )?(down|up)\b", r" \1-\4 "),
        (r"\b(stands?|standing) (still|motionless)\b", " stand "),
        (r"\b(tak|hav|grab)(es?|s|ing) (a|{own}) ?seat\b|\b(is |be |gets? )?seated\b", " sit "),
        (r"\b(hands?|arms?) (together) in a clap\b", " clap "),
        (r"\bup in a kick\b", " "),
        (r"\bback(s|ing|ed)? (away|up|off)\b", " walk backwards "),
        (
            r"\bthrow(s|ing)? {own}(arms?|hands?) (up|overhead)\b",
            r" raise \2 ",
        ),
        (
            r"\bbr(ings?|inging) {own}(hands|arms|palms)? ?(clap|together)",
            " clap ",
        ),
        (r"\b(round of )?applause\b", " clap "),
        (
            r"\bbend(s|ing)? {own}knees\b|\bknee bends?\b|\bducks? down\b",
            " squat ",
        ),
        (
            r"\b(bend|lean|stoop)(s|ing)?( {own}body)?( over| forwards?| down)*\b",
            " bow ",
        ),
        (r"\b(side ?step|side-step)(s|ping|ped)?\b|\bsteps? (to the )?sides?\b", " step sideways "),
        (r"\bsay(s|ing)? (hello|hi|goodbye|bye)\b", " wave "),
        (r"\bhello\b|\bhi\b|\bgoodbye\b|\bgood-bye\b|\bbye\b", " "),
        (
            r"\b(in(to)? the air|above {own}heads?|over {own}heads?|overhead)\b",
            " overhead ",
        ),
        (
            r"\bwith {own}(left |right )?(arm|hand)(s?) "
            r"(?:(?:held|kept|stretched) )?(?:raised|up|overhead|high)(?: up| high| overhead)?\b",
            lambda m: f" hold-{(m[1] or m[3] or '').strip()} ",
        ),
        (
            r"(^|[|,&]|\band\b)\s*{own}(left |right )?(arm|hand)(s?) "
            r"(?:raised|up|overhead|high)\b",
            lambda m: f"{m[1]} & hold-{(m[2] or m[4] or '').strip()} ",
        ),
        (r"^(.*)\band\b(?!.*(?:hands|palms|arms) together)(.*) together\b", r"\1 & \2"),
        (
            r"(\bturn(?:s|ing)? a?round\b.*?\b(?:walk|run|jog|go|stroll)(?:e?s|ing)?) back\b",
            r"\1 forward",
        ),
        (r"\bjumping jacks?\b|\bstar jumps?\b", " jumping-jacks "),
    )
)
HEADS = {
    **dict.fromkeys(
        "walk stroll stride amble wander go move step travel advance enter exit leave"
        " approach edge inch creep".split(),
        "walk",
    ),
    **dict.fromkeys("run jog race sprint dash".split(), "run"),
    "retreat": "back",
    **dict.fromkeys("strafe sidle".split(), "aside"),
    "shuffle": "walk",
    **dict.fromkeys("turn rotate pivot face".split(), "turn"),
    **dict.fromkeys("spin twirl whirl".split(), "spin"),
    **dict.fromkeys("stand wait stay pause stop halt freeze idle".split(), "stand"),
    **dict.fromkeys("squat crouch duck dip".split(), "squat"),
    **dict.fromkeys("jump hop leap spring bounce".split(), "jump"),
    "kick": "kick",
    **dict.fromkeys("sit settle".split(), "sit"),
    "rise": "rise",
    **dict.fromkeys("bow stoop".split(), "bow"),
    **dict.fromkeys("wave signal greet".split(), "wave"),
    **dict.fromkeys("raise lift reach put stick".split(), "raise"),
    "stretch": "stretch",
    **dict.fromkeys("hold keep have has hold- hold-s hold-left hold-right".split(), "hold"),
    **dict.fromkeys("punch jab hit box uppercut hook".split(), "punch"),
    "strike": "strike",
    "swing": "strike",
    **dict.fromkeys("clap applaud".split(), "clap"),
    **dict.fromkeys("point show gesture indicate".split(), "point"),
}
# nouns, too: "does two jumps"; others are verbs alone
LIGHT = frozenset(
    "do does doing did make give take perform deliver land execute throw get try go".split()
)
SIDES = {
    **dict.fromkeys("left lefty southpaw counterclockwise anticlockwise".split(), "left"),
    **dict.fromkeys("right righty clockwise".split(), "right"),
    **dict.fromkeys("both two-handed".split(), "both"),
    "either": "",
}
NUMBERS = {
    "once": 1, "one": 1, "single": 1, "twice": 2, "two": 2, "thrice": 3, "three": 3, "four": 4,
    "few": 3, "several": 3, "some-times": 3, "five": 5, "six": 6,
    "seven": 7, "eight": 8, "nine": 9, "ten": 10, "dozen": 12,
}  # fmt: skip
PACES = {
    **dict.fromkeys(
        "slowly slow gently gentle leisurely calmly lazily unhurried carefully".split(), "slowly"
    ),
    **dict.fromkeys(
        "quickly quick fast rapidly rapid briskly brisk hastily swiftly swift speedily hurriedly"
        " frantically furiously".split(),
        "quickly",
    ),
}
WAYS = {
    **dict.fromkeys("forward forwards ahead onward onwards straight front".split(), "forward"),
    **dict.fromkeys("back backward backwards rearward rearwards reverse".split(), "back"),
    **dict.fromkeys("sideways side sides aside sideward laterally sidewards".split(), "aside"),
    **dict.fromkeys("around round".split(), "around"),
    **dict.fromkeys("up upward upwards overhead raised high".split(), "up"),
    "on-the-spot": "place",
}
LIMBS = {
    **dict.fromkeys("hand hands arm arms fist fists palm palms".split(), "arm"),
    **dict.fromkeys("leg legs foot feet knee knees".split(), "leg"),
}
FILLERS = PASSED_OVER | frozenset(
    "and or with without to in out over again also along down low deep deeply place pace time times"
    " chair stool seat air shoulder body person man woman figure people child politely hard happily"
    " proudly casually lightly softly nicely bit motion movement spot floor ground own way himself"
    " herself itself themselves still same then more please pls thanks thx let make together ok"
    " okay so um uh hmm well maybe away off over excitedly"
    " enthusiastically cheerfully joyfully again-it another rather good nice across room stage"
    " street second towards toward using super normal throughout".split()
)
# counts that are not meant exactly: steps of a walk are not counted
VAGUE = frozenset("few several some-times".split())
# after "a" or "the" these are things, no acts
THINGS = frozenset("box face point show stand exit".split())
# acts that are done to somebody, who is named after these words and need not be there
TOWARDS = ("to", "at", "for")
WHOSE = frozenset("a an the his her their my your its our all some".split())
ADDRESSED = frozenset("wave bow clap point raise".split())


def rewritten(text: str) -> str:
    """The text in small letters, with | between acts in a row and & between acts at once."""
    low = re.sub(r"[’`]", "'", text.lower())
    low = re.sub(r"[.;!?:\n]+", " | ", low)
    for pattern, other in REWRITTEN:
        low = " ".join(pattern.sub(other, low).split())
    return re.sub(r"\|[| ]*&", "&", other_side(in_their_order(low)))


def in_their_order(low: str) -> str:
    """Acts in the order in which they are done: "X after Y", "before X, Y", "X, but first Y"."""
    for word, first in ((r"\bafter\b", 1), (r"(?:[|,]|\bbut\b|\band\b)* ?\bbefore-it\b,?", 1)):
        pieces = re.split(word, low)
        if len(pieces) == 2 and pieces[0].strip(" |,"):
            low = f"{pieces[first]} | {pieces[1 - first]}"
        elif len(pieces) == 2:
            low = pieces[1].replace(",", " | ", 1)
    for later in (r"([^,|]*),(.*)", rf"([^,|]+?) (?={WHO}\b)(.*)"):  # "before he sits he bows"
        match = re.match(rf"[ |,]*before\b{later}", low)
        low = f"{match[2]} | {match[1]}" if match else low
    return re.sub(r"\bbefore\b", " | ", low)


def other_side(low: str) -> str:
    """With "left" or "right" in place of "the other hand"."""
    last, words = "", low.split()
    for k, word in enumerate(words):
        after = words[k + 1] if k + 1 < len(words) else "|"
        if word == "one" and after in LIMBS and "other" in words[k:]:
            words[k] = word = ONE[1]
        last = word.strip(",") if word.strip(",") in ONE else last
        if word == "other" and last and after.strip(",") in {*LIMBS, "side", "one", "|", "&", ""}:
            words[k] = last = ONE[1 - ONE.index(last)]
    return " ".join(words)
