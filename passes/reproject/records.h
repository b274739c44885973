// Constants of pass reproject.
#pragma once

#include "../../shaders/records/shared.h"

SHARED_BEGIN(fovea::passes::reproject)

// Width in pixels of the tile that a work group of fill.comp works on; it holds whole blocks of any allowed size.
SHARED_CONSTANT int kTile = 16;

// Pixels that a work group of warp.comp works on: kRows vertically adjacent ones per invocation, all in one tile.
SHARED_CONSTANT int kRowWidth = 64, kRows = 4;

SHARED_END
