"""A CLIP of two layers with random weights, in a folder, as `transformers` loads it."""

import string
from pathlib import Path

import torch

LETTERS = string.printable[:94]  # of ASCII, without white space
WHOLE = ("walks", "kicks", "left", "right", "a", "the", "person", "forward", "with", "foot")
WIDTH, LONGEST = 32, 24
START, END = 0, 1  # the ids of the marks


def tokenizer():
    """CLIP's tokenizer with WHOLE as whole words; all others are spelled."""
    from transformers import CLIPTokenizer

    pieces = ["<|startoftext|>", "<|endoftext|>", *LETTERS, *(f"{one}</w>" for one in LETTERS)]
    merges = []
    for word in WHOLE:
        parts = [*word[:-1], f"{word[-1]}</w>"]
        while len(parts) > 1:  # from its end, so that no word takes the beginning of another
            merges.append((parts[-2], parts[-1]))
            parts = [*parts[:-2], parts[-2] + parts[-1]]
            pieces.append(parts[-1])
    ids = {piece: k for k, piece in enumerate(dict.fromkeys(pieces))}
    return CLIPTokenizer(vocab=ids, merges=list(dict.fromkeys(merges)))


def sizes() -> dict:
    """What CLIPTextConfig takes for this CLIP."""
    return {
        "vocab_size": len(tokenizer()),
        "hidden_size": WIDTH,
        "intermediate_size": 48,
        "num_hidden_layers": 2,
        "num_attention_heads": 4,
        "max_position_embeddings": LONGEST,
        "bos_token_id": START,
        "eos_token_id": END,
    }


def made(folder: Path, seed: int = 0, **changes) -> Path:
    """Write the text transformer and its tokenizer."""
    from transformers import CLIPTextConfig, CLIPTextModel

    torch.manual_seed(seed)
    model = CLIPTextModel(CLIPTextConfig(**(sizes() | changes)))
    with torch.no_grad():  # fresh ones are too small to matter
        for parameter in model.parameters():
            parameter += 0.3 * torch.randn_like(parameter)
    model.save_pretrained(folder)
    tokenizer().save_pretrained(folder)
    return folder


def with_eyes(folder: Path) -> Path:
    """Write a whole CLIP, with the half that sees, as they are on the hub."""
    from transformers import CLIPConfig, CLIPModel

    eye = {
        "hidden_size": 16,
        "intermediate_size": 24,
        "num_hidden_layers": 1,
        "num_attention_heads": 2,
        "image_size": 32,
        "patch_size": 16,
    }
    torch.manual_seed(5)
    CLIPModel(CLIPConfig(text_config=sizes(), vision_config=eye)).save_pretrained(folder)
    tokenizer().save_pretrained(folder)
    return folder
