#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// What a scene without a "film" gets: as FilmSettings, with all layers.
FilmSettings defaultFilm();
FilmSettings readFilm(const Node& node);
KeyList filmKeys();

}  // namespace sss
