// PassSums.cpp - joins sums that machines have made apart. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/PassSums>

#include "osgRayTrace/PassSumsState.h"
#include "osgRayTrace/bridge/common/PixelImage.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/bridge/update/RenderOptionsFromSettings.h"
#include "osgRayTrace/film/Resolve.h"

#include <algorithm>
#include <sstream>

namespace osgRayTrace
{

namespace
{

constexpr int64_t kLargestSum = int64_t(1) << 61; ///< of sums that can be added without overflow

/// Returns the first line in which two texts differ: "seed 1, and seed 2".
std::string difference(const std::string& a, const std::string& b)
{
    std::istringstream first(a), second(b);
    std::string one, other;
    do
    {
        one.clear();
        other.clear();
        std::getline(first, one);
        std::getline(second, other);
    } while (one == other && (first || second));
    return (one.empty() ? "nothing" : one) + ", and " + (other.empty() ? "nothing" : other);
}

} // namespace

std::string whyNotOf(const PassSums& sums, const std::string& picture)
{
    if (sums.picture == picture) return {};
    return "the passes are of another picture: " + difference(sums.picture, picture);
}

std::optional<engine::PassSums> engineSums(PassSums sums)
{
    const std::optional<engine::PassSet> passes = engine::passSetOf(sums.passes);
    engine::PassSums result;
    if (!passes || sums.width < 1 || sums.height < 1 ||
        int64_t(sums.width) * sums.height > engine::Film::kMaxPixels)
        return std::nullopt;
    result.width = sums.width;
    result.height = sums.height;
    const std::size_t values = engine::PassSums::kPlanes * result.pixels();
    if (sums.low.size() != values || (!sums.high.empty() && sums.high.size() != values) ||
        (!sums.depth.empty() && sums.depth.size() != result.pixels()))
        return std::nullopt;
    const auto isSum = [](int64_t value) { return value >= -kLargestSum && value <= kLargestSum; };
    if (!std::all_of(sums.low.begin(), sums.low.end(), isSum) ||
        !std::all_of(sums.high.begin(), sums.high.end(), isSum))
        return std::nullopt;
    result.passes = *passes;
    result.low = std::move(sums.low);
    result.high = std::move(sums.high);
    result.depth = std::move(sums.depth);
    engine::normalise(result);
    return result;
}

PassSums publicSums(engine::PassSums sums)
{
    PassSums result;
    result.width = sums.width;
    result.height = sums.height;
    result.passes = engine::passText(sums.passes);
    result.low = std::move(sums.low);
    result.high = std::move(sums.high);
    result.depth = std::move(sums.depth);
    return result;
}

std::string PassSums::add(const PassSums& other)
{
    try
    {
        if (width != other.width || height != other.height)
            return "the pictures are of different sizes";
        const std::string other_picture = whyNotOf(other, picture);
        if (!other_picture.empty()) return other_picture;
        std::optional<engine::PassSums> own = engineSums(*this), more = engineSums(other);
        if (!own || !more) return "the sums are damaged";
        if (const auto pass = own->passes.firstCommon(more->passes))
            return "both have pass " + std::to_string(*pass);
        engine::addSums(*more, *own);
        PassSums joined = publicSums(std::move(*own));
        joined.picture = picture;
        joined.displayReferred = displayReferred;
        joined.veiled = veiled;
        *this = std::move(joined);
        return {};
    }
    catch (const std::exception& error)
    {
        return error.what();
    }
}

int PassSums::passCount() const
{
    const std::optional<engine::PassSet> set = engine::passSetOf(passes);
    return set ? set->count() : 0;
}

namespace
{

/// Returns what make returns for the film of the sums; null if that fails.
template <typename Make> osg::ref_ptr<osg::Image> imageOf(const PassSums& sums, const Make& make)
{
    try
    {
        const std::optional<engine::PassSums> own = engineSums(sums);
        if (!own || own->passes.empty()) return nullptr;
        engine::Film film;
        engine::setFilm(*own, film);
        return make(film);
    }
    catch (const std::exception& error)
    {
        engine::warnOnce(std::string("an image could not be made: ") + error.what());
        return nullptr;
    }
}

} // namespace

osg::ref_ptr<osg::Image> PassSums::getColorImage() const
{
    const auto make = [this](const engine::Film& film)
    {
        const osg::ref_ptr<osg::Image> image =
            engine::newPixelImage(width, height, GL_RGBA, GL_FLOAT);
        for (int tile = 0; image && tile < film.tileCount(); ++tile)
            engine::resolveTileRadiance(film, tile, displayReferred,
                                        reinterpret_cast<float*>(image->data()));
        return image;
    };
    return imageOf(*this, make);
}

osg::ref_ptr<osg::Image> PassSums::getDisplayImage(float exposureEv, const osg::Vec4& clearColor,
                                                   const std::string& toneCurve) const
{
    const osg::ref_ptr<RayTraceSettings> shown = new RayTraceSettings;
    if (!shown->set("tone-curve", toneCurve)) return nullptr;
    engine::ToneMap toneMap{exposureEv, displayReferred, engine::toneCurve(shown->getToneCurve())};
    engine::setVeiled(veiled, clearColor, toneMap);
    const auto make = [&](const engine::Film& film)
    {
        const osg::ref_ptr<osg::Image> image =
            engine::newPixelImage(width, height, GL_RGBA, GL_UNSIGNED_BYTE);
        for (int tile = 0; image && tile < film.tileCount(); ++tile)
            engine::resolveTileDisplay(film, tile, toneMap, image->data(), nullptr);
        if (image) engine::blendOver(*image, clearColor);
        return image;
    };
    return imageOf(*this, make);
}

} // namespace osgRayTrace
