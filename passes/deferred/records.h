// Constants of pass deferred.
#pragma once

#include "../../shaders/records/shared.h"

SHARED_BEGIN(fovea::passes::deferred)

// Pixels that a work group works on (in shade.comp, pixels of one subset). Pass reproject counts the groups of the
// indirect dispatch in the same way.
SHARED_CONSTANT int kTileWidth = 16, kTileHeight = 16;

SHARED_END
