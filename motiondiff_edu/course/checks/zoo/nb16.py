"""Wrong answers to the exercises of notebook 16."""

from ....motion.skeleton import MIRROR

SIDES = {"left": "right", "right": "left"}


def padding_in_the_mean(tokens, mask):
    """A short text's bag depends on the longest text of the batch."""
    return tokens.mean(1)


def divided_by_the_longest(tokens, mask):
    """Padding is set to zero, but it is still counted."""
    return (tokens * mask[..., None]).mean(1)


def sum_of_words(tokens, mask):
    """A long text has a large bag."""
    return (tokens * mask[..., None]).sum(1)


def first_word(tokens, mask):
    """Looks only at the first word."""
    return tokens[:, 0]


def swapped(with_text, without, w):
    """A large w leads away from the text."""
    return with_text + w * (without - with_text)


def from_the_text(with_text, without, w):
    """w = 1 is not the conditional, but goes beyond it already."""
    return with_text + w * (with_text - without)


def text_alone(with_text, without, w):
    """Only scales the noise that is taken away."""
    return w * with_text


def wrong_sign(with_text, without, w):
    """The two weights do not sum to one."""
    return w * with_text - (1 - w) * without


def words_forgotten(positions, words):
    """The figure waves with the other hand, and the caption does not know."""
    return positions[:, MIRROR] * [-1.0, 1.0, 1.0], words


def joints_forgotten(positions, words):
    """The picture is reflected; the joint named left is now on the right."""
    return positions * [-1.0, 1.0, 1.0], tuple(SIDES.get(word, word) for word in words)


def one_after_the_other(positions, words):
    """First every left becomes right, then every right becomes left."""
    words = tuple("right" if word == "left" else word for word in words)
    words = tuple("left" if word == "right" else word for word in words)
    return positions[:, MIRROR] * [-1.0, 1.0, 1.0], words


ZOO = {
    "bag": {
        "padding in the mean": padding_in_the_mean,
        "divided by the longest": divided_by_the_longest,
        "sum": sum_of_words,
        "first word": first_word,
    },
    "guided": {
        "swapped": swapped,
        "from the text": from_the_text,
        "text alone": text_alone,
        "wrong sign": wrong_sign,
    },
    "mirrored": {
        "words forgotten": words_forgotten,
        "joints forgotten": joints_forgotten,
        "one after the other": one_after_the_other,
    },
}
