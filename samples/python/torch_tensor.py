# %% [markdown]
# # A picture as a tensor
#
# Arrays go to PyTorch through DLPack. Here a picture of few light paths per pixel becomes a tensor, a convolution smooths
# it, the simplest of denoisers, and both are compared with a reference.

# %% Parameters
SIZE = (128, 128)
SAMPLES = 64  # of the reference, per pixel

# %% An output of a graph as a tensor: channels x height x width.
import torch  # type: ignore[import-not-found,unused-ignore]

import fovea

renderer = fovea.Renderer("reference", scene="cornellbox", size=SIZE, set={"spp": 4})
radiance = renderer.frame()["radiance"]
tensor = torch.from_dlpack(radiance.copy()).permute(2, 0, 1)[None, :3]

# %% A blur of three by three pixels, each channel by itself.
kernel = torch.full((3, 1, 3, 3), 1 / 9)
smooth = torch.nn.functional.conv2d(torch.nn.functional.pad(tensor, (1, 1, 1, 1), mode="replicate"), kernel, groups=3)

# %% Back to an array, and its error beside that of the picture.
reference = fovea.reference("cornellbox", size=SIZE, spp=SAMPLES)
for name, picture in {"as rendered": radiance, "smoothed": smooth[0].permute(1, 2, 0).numpy()}.items():
    print(f"{name}: MSE × 1000 = {1000 * fovea.compare(picture[..., :3], reference)['whole']['mse']:.3f}")
