#include "sss/scene/film_reader.h"

#include "sss/base/near_name.h"

#include <algorithm>

namespace sss {
namespace {

constexpr int kLargestSide = 32768;
constexpr int kMostSamples = 1 << 20;

constexpr std::string_view kLayers[] = {"diffusion", "single", "surface", "albedo", "N", "Z"};
// In the order of FilterKind.
constexpr std::string_view kFilters[] = {"box", "tent", "gaussian", "blackman-harris"};
constexpr std::string_view kPrecisions[] = {"half", "float"};

void readLayers(FilmSettings& film, const Node& node) {
    film.layers.clear();
    for (const Node& entry : entries(node, 0, std::size(kLayers))) {
        std::string layer(kLayers[choice(entry, kLayers)]);
        if (std::ranges::find(film.layers, layer) != film.layers.end()) {
            fail(entry, "names " + inQuotes(layer) + " a second time", "name each layer once");
        }
        film.layers.push_back(std::move(layer));
    }
}

constexpr Field<FilmSettings> kFilmFields[] = {
    {"width", [](FilmSettings& f, const Node& n) { f.width = wholeNumber(n, 1, kLargestSide); }},
    {"height", [](FilmSettings& f, const Node& n) { f.height = wholeNumber(n, 1, kLargestSide); }},
    {"samples",
     [](FilmSettings& f, const Node& n) { f.samples = wholeNumber(n, 1, kMostSamples); }},
    {"filter", [](FilmSettings& f,
                  const Node& n) { f.filter = static_cast<FilterKind>(choice(n, kFilters)); }},
    {"filterRadius",
     [](FilmSettings& f, const Node& n) {
         f.filterRadiusPixels = number(n, {0.5, 16, false, false, "pixels"});
     }},
    {"layers", readLayers},
    {"exposureStops",
     [](FilmSettings& f, const Node& n) {
         f.exposureStops = number(n, {-30, 30});
     }},
    {"precision",
     [](FilmSettings& f, const Node& n) { f.halfPrecision = choice(n, kPrecisions) == 0; }},
};

}  // namespace

FilmSettings defaultFilm() {
    FilmSettings film;
    film.layers.assign(std::begin(kLayers), std::end(kLayers));
    return film;
}

FilmSettings readFilm(const Node& node) {
    FilmSettings film = defaultFilm();
    FieldSet fields;
    fields.add(film, kFilmFields);
    fields.read(node);
    return film;
}

KeyList filmKeys() { return listRows<FilmSettings>("film", kFilmFields); }

}  // namespace sss
