"""Clip -> embedding, in three sizes that every trained method can be given.

- `densenet121`: the paper's, DenseNet-121 on each frame and a long short-term memory over the frames.  Where the
  processor multiplies bfloat16, it learns in that (the weights, and all that is embedded afterwards, are float32).
- `small`: the same structure with three layers on each frame; a training step with 64 clips takes 45 ms.
- `scores`: nothing is learned from pixels: the clip's principal components (pca.py) and two full layers; 3 ms
  a step, so that the same budget sees the data fifteen times as often.  The study uses this one.
"""

from __future__ import annotations

import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
from torch import nn  # pyright: ignore[reportMissingImports] - in the extra `learn`

from ....sim.errors import CaretreeError

CHANNELS = 2  # covered share, relative depth: see frames.py
EMBEDDING = 64
BACKBONES = ("scores", "small", "densenet121")


class SmallFrameNet(nn.Sequential):
    """Patches of 4 x 4 pixels, one convolution over them and one full layer: (B, 2, S, S) -> (B, features).

    A third of the time of four usual convolutions, because wide and few operations suit a processor.
    """

    def __init__(self, size: int, features: int, widths: tuple[int, int] = (32, 64)) -> None:
        patches, side = widths[0], (size // 4 + 1) // 2
        # no pooling over the image: where the hem is tells more than that there is one
        super().__init__(
            nn.Conv2d(CHANNELS, patches, 4, stride=4), nn.ReLU(),
            nn.Conv2d(patches, widths[1], 3, stride=2, padding=1), nn.ReLU(),
            nn.Flatten(), nn.Linear(widths[1] * side * side, features), nn.ReLU(),
        )  # fmt: skip


class ClipEmbedding(nn.Module):
    """f_e of the paper: frames of one clip -> one embedding.

    Args:
        name: one of `BACKBONES`.
        size: edge of a frame in pixels, or the number of scores.
        embedding: length of the embedding.
        features: numbers per frame handed to the memory.

    Raises:
        CaretreeError: the name is none of `BACKBONES`.
    """

    def __init__(self, name: str = "small", *, size: int = 32, embedding: int = EMBEDDING, features: int = 128) -> None:
        super().__init__()
        if name not in BACKBONES:
            raise CaretreeError(f"there is no backbone {name!r}; there are {', '.join(BACKBONES)}")
        self.embedding, self.name = embedding, name
        if name == "scores":
            self.net = head(size, embedding)
            return
        if name == "small":
            self.frame_net: nn.Module = SmallFrameNet(size, features)
        else:
            from .densenet import densenet121

            # channels last: a third of the time less, since most convolutions are 1 x 1
            self.frame_net = densenet121(channels=CHANNELS, features=features)
            self.frame_net.to(memory_format=torch.channels_last)  # pyright: ignore[reportCallIssue] - not in its types
        self.memory = nn.LSTM(features, features, batch_first=True)
        self.out = nn.Linear(features, embedding)

    def forward(self, frames: torch.Tensor) -> torch.Tensor:
        """Embed clips: (B, T, 2, S, S) float frames, or (B, S) scores, -> (B, embedding)."""
        if self.name == "scores":
            return self.net(frames * frames.shape[1] ** 0.5)  # scores are small: their squares sum to one
        b, t = frames.shape[:2]
        flat = frames.flatten(0, 1)
        if self.name == "densenet121":
            flat = flat.contiguous(memory_format=torch.channels_last)
        with torch.autocast("cpu", torch.bfloat16, enabled=self.name == "densenet121" and self.training and has_half()):
            per_frame = self.frame_net(flat).float().reshape(b, t, -1)
        states, _ = self.memory(per_frame)
        return self.out(states[:, -1])


def has_half() -> bool:
    """Whether the processor multiplies bfloat16 itself; where it does not, that is slower than float32."""
    return bool(getattr(torch.cpu, "_is_avx512_bf16_supported", lambda: False)())


def head(inputs: int, outputs: int, width: int = 256) -> nn.Sequential:
    """A fully connected network with two hidden layers, as behind every embedding here."""
    return nn.Sequential(
        nn.Linear(inputs, width), nn.ReLU(), nn.Linear(width, width), nn.ReLU(), nn.Linear(width, outputs)
    )


@torch.no_grad()
def embed(network: nn.Module, frames: torch.Tensor, batch: int = 128) -> torch.Tensor:
    """Outputs of a network for many clips: (N, ...) float16 or float32 -> (N, outputs) float32."""
    network.eval()
    return torch.cat([network(frames[i : i + batch].float()) for i in range(0, len(frames), batch)])
