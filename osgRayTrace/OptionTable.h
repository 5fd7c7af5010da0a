// OptionTable.h - the options with their names, ranges and words. Layer: public API.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceSettings>

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace osgRayTrace
{

template <typename T> struct Range
{
    T minimum;
    T maximum;

    /// Returns whether the value is within the range; false for NaN.
    bool contains(T value) const { return value >= minimum && value <= maximum; }
};

constexpr Range<int> kLightSamplesRange{1, 4096};
constexpr Range<int> kEnvironmentSamplesRange{1, 4096};
constexpr Range<float> kLightRadiusRange{0.0f, 1e30f};
constexpr Range<float> kLightAngleRange{0.0f, 180.0f};
constexpr Range<float> kPointRadiusRange{0.0f, 1e30f};
constexpr Range<int> kMaxBouncesRange{0, 1024};
constexpr Range<int> kMaxPassesRange{1, 1 << 24};
constexpr Range<float> kFrameBudgetRange{0.0f, 60000.0f};
constexpr Range<int> kPassesPerFrameRange{1, 1024};
constexpr Range<int> kThreadsRange{0, 1024};
constexpr Range<unsigned int> kSeedRange{0, std::numeric_limits<unsigned int>::max()};
constexpr Range<float> kExposureRange{-32.0f, 32.0f};
constexpr Range<float> kApertureRange{0.0f, 1e30f};
constexpr Range<float> kFocusRange{0.0f, 1e30f};
constexpr Range<int> kPhotonsRange{0, 1 << 24};
constexpr Range<int> kPhotonBeamsRange{1, 1 << 24};
constexpr Range<float> kPhotonRadiusRange{0.0f, 1e30f};
constexpr Range<float> kPhotonAlphaRange{0.1f, 0.99f};

/// Refers to the words of a choice, which stand in an array that is never destroyed.
class Words
{
public:
    template <std::size_t N>
    constexpr Words(const std::string_view (&words)[N]) : _begin(words), _size(N)
    {
    }

    constexpr const std::string_view* begin() const { return _begin; }
    constexpr const std::string_view* end() const { return _begin + _size; }
    constexpr std::size_t size() const { return _size; }

private:
    const std::string_view* _begin;
    std::size_t _size;
};

// The words of a choice stand in the order of its enumerators.

inline constexpr std::string_view kIntegratorWords[] = {"auto", "whitted",         "path", "ppm",
                                                        "sppm", "photon-caustics", "debug"};
inline constexpr std::string_view kRadiusScheduleWords[] = {"global", "local"};
inline constexpr std::string_view kLightSamplingWords[] = {"random", "uniform-jitter", "stratified",
                                                           "sobol"};
inline constexpr std::string_view kEnvironmentSamplingWords[] = {"importance", "structured",
                                                                 "uniform"};
inline constexpr std::string_view kDebugChannelWords[] = {"normal", "uv",      "id",  "albedo",
                                                          "depth",  "dropped", "cost"};
inline constexpr std::string_view kToneCurveWords[] = {"srgb", "neutral", "agx"};
inline constexpr std::string_view kDenoiseWords[] = {"off", "filter", "oidn"};
inline constexpr std::string_view kFogWords[] = {"depth", "medium", "off"};
inline constexpr std::string_view kPresentationWords[] = {"frame-locked", "background"};
inline constexpr std::string_view kColorRuleWords[] = {"auto", "display-referred", "linear"};

/// Holds one row of the table.
struct OptionRow
{
    RayTraceSettings::Option option; ///< without the default value
    std::function<bool(RayTraceSettings&, const std::string&)> set;
    std::function<std::string(const RayTraceSettings&)> get;
};

/// Returns all rows in the order of the documents' table of settings.
const std::vector<OptionRow>& optionTable();

/// Returns the row of an option, by any spelling of its name or of its former name; null if there
/// is no such option.
const OptionRow* findRow(const std::string& name);

/// Returns whether a name is a spelling of the option's former name.
bool isFormerName(const OptionRow& row, const std::string& name);

/// Returns the environment variable of an option of this name.
std::string environmentName(const std::string& name);

bool areLightSizes(const std::string& text);
bool isGround(const std::string& text);
bool areServers(const std::string& text);

} // namespace osgRayTrace
