// RayTraceSettings.cpp - the table of options; setters that keep to ranges. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTraceSettings>

#include "osgRayTrace/bridge/LightSizes.h"
#include "osgRayTrace/bridge/MaterialLibrary.h"
#include "osgRayTrace/bridge/WarnOnce.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <limits>

namespace osgRayTrace
{

using engine::warnOnce;

namespace
{

template <typename T> struct Range
{
    T minimum;
    T maximum;

    /// False for NaN.
    bool contains(T value) const { return value >= minimum && value <= maximum; }
};

constexpr Range<int> kLightSamplesRange{1, 4096};
constexpr Range<int> kEnvironmentSamplesRange{1, 4096};
constexpr Range<float> kLightRadiusRange{0.0f, 1e30f};
constexpr Range<float> kLightAngleRange{0.0f, 180.0f};
constexpr Range<int> kMaxBouncesRange{0, 1024};
constexpr Range<int> kMaxPassesRange{1, 1 << 24};
constexpr Range<int> kPassesPerFrameRange{1, 1024};
constexpr Range<int> kThreadsRange{0, 1024};
constexpr Range<unsigned int> kSeedRange{0, std::numeric_limits<unsigned int>::max()};
constexpr Range<float> kExposureRange{-32.0f, 32.0f};
constexpr Range<int> kPhotonsRange{0, 1 << 24};
constexpr Range<float> kPhotonRadiusRange{0.0f, 1e30f};
constexpr Range<float> kPhotonAlphaRange{0.1f, 0.99f};

/// One row of the table. The words of a choice stand in the order of its enumerators.
struct OptionRow
{
    RayTraceSettings::Option option; ///< but for the default value
    std::function<bool(RayTraceSettings&, const std::string&)> set;
    std::function<std::string(const RayTraceSettings&)> get;
};

using Words = std::vector<std::string>;

const Words kIntegratorWords{"auto", "whitted", "path", "ppm", "sppm", "photon-caustics", "debug"};
const Words kRadiusScheduleWords{"global", "local"};
const Words kLightSamplingWords{"random", "uniform-jitter", "stratified", "sobol"};
const Words kEnvironmentSamplingWords{"importance", "structured", "uniform"};
const Words kDebugChannelWords{"normal", "uv", "id", "albedo", "depth", "dropped", "cost"};
const Words kColorRuleWords{"auto", "display-referred", "linear"};
const Words kSwitchWords{"false", "true"};

/// Lower case without dashes and underscores: "light-samples", "LIGHT_SAMPLES" and "lightSamples"
/// agree.
std::string plainName(const std::string& name)
{
    std::string plain;
    for (char c : name)
    {
        if (c == '-' || c == '_') continue;
        plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return plain;
}

std::string environmentName(const std::string& name)
{
    std::string variable = "OSGRAYTRACE_";
    for (char c : name)
    {
        variable += c == '-' ? '_' : static_cast<char>(c - 'a' + 'A');
    }
    return variable;
}

/// Shortest text that reads back as the same value, in any locale.
template <typename T> std::string textOf(T value)
{
    char buffer[64];
    const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
    return std::string(buffer, result.ptr);
}

/// False unless all of the text is one number within the range.
template <typename T> bool parseNumber(const std::string& text, const Range<T>& range, T& value)
{
    const char* begin = text.data();
    const char* end = begin + text.size();
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++begin;
    const auto result = std::from_chars(begin, end, value);
    return result.ec == std::errc() && result.ptr == end && range.contains(value);
}

RayTraceSettings::Option describe(const std::string& name, const std::string& range,
                                  const std::string& help)
{
    return {name, environmentName(name), std::string(), range, help};
}

template <typename T>
OptionRow numberRow(const std::string& name, const Range<T>& range,
                    T (RayTraceSettings::*get)() const, void (RayTraceSettings::*set)(T),
                    const std::string& help)
{
    OptionRow row;
    row.option = describe(name, textOf(range.minimum) + " .. " + textOf(range.maximum), help);
    row.get = [get](const RayTraceSettings& settings) { return textOf((settings.*get)()); };
    row.set = [range, set](RayTraceSettings& settings, const std::string& text)
    {
        T value{};
        if (!parseNumber(text, range, value)) return false;
        (settings.*set)(value);
        return true;
    };
    return row;
}

template <typename T>
OptionRow choiceRow(const std::string& name, const Words& words, T (RayTraceSettings::*get)() const,
                    void (RayTraceSettings::*set)(T), const std::string& help)
{
    std::string range;
    for (const std::string& word : words)
    {
        range += (range.empty() ? "" : "|") + word;
    }

    OptionRow row;
    row.option = describe(name, range, help);
    row.get = [&words, get](const RayTraceSettings& settings)
    { return words[static_cast<size_t>((settings.*get)())]; };
    row.set = [&words, set](RayTraceSettings& settings, const std::string& text)
    {
        const auto isMeant = [&text](const std::string& word)
        { return plainName(word) == plainName(text); };
        const auto found = std::find_if(words.begin(), words.end(), isMeant);
        if (found == words.end()) return false;
        (settings.*set)(static_cast<T>(found - words.begin()));
        return true;
    };
    return row;
}

/// As a choice; 0 and 1, off and on, no and yes are understood too.
OptionRow switchRow(const std::string& name, bool (RayTraceSettings::*get)() const,
                    void (RayTraceSettings::*set)(bool), const std::string& help)
{
    OptionRow row = choiceRow(name, kSwitchWords, get, set, help);
    row.set = [choose = row.set](RayTraceSettings& settings, const std::string& text)
    {
        const std::string word = plainName(text);
        if (word == "1" || word == "on" || word == "yes") return choose(settings, "true");
        if (word == "0" || word == "off" || word == "no") return choose(settings, "false");
        return choose(settings, text);
    };
    return row;
}

/// Any text that isGood takes.
OptionRow textRow(const std::string& name, const std::string& range,
                  const std::string& (RayTraceSettings::*get)() const,
                  void (RayTraceSettings::*set)(const std::string&), bool (*isGood)(const std::string&),
                  const std::string& help)
{
    OptionRow row;
    row.option = describe(name, range, help);
    row.get = [get](const RayTraceSettings& settings) { return (settings.*get)(); };
    row.set = [set, isGood](RayTraceSettings& settings, const std::string& text)
    {
        if (!isGood(text)) return false;
        (settings.*set)(text);
        return true;
    };
    return row;
}

bool isAnything(const std::string&)
{
    return true;
}

bool areLightSizes(const std::string& text)
{
    return engine::parseLightSizes(text).has_value();
}

const std::vector<OptionRow>& optionTable()
{
    using S = RayTraceSettings;
    static const std::vector<OptionRow> table{
        choiceRow("integrator", kIntegratorWords, &S::getIntegrator, &S::setIntegrator,
                  "How light is computed; auto: whitted for fixed-function scenes, path for "
                  "physical ones, photon-caustics for those with mirrors or glass"),
        choiceRow("light-sampling", kLightSamplingWords, &S::getLightSampling, &S::setLightSampling,
                  "How points on area lights are chosen"),
        numberRow("light-samples", kLightSamplesRange, &S::getLightSamples, &S::setLightSamples,
                  "Samples a hit and area light, and light with a size"),
        choiceRow("environment-sampling", kEnvironmentSamplingWords, &S::getEnvironmentSampling,
                  &S::setEnvironmentSampling, "How directions towards the environment are chosen"),
        numberRow("environment-samples", kEnvironmentSamplesRange, &S::getEnvironmentSamples,
                  &S::setEnvironmentSamples,
                  "Lights that structured sampling makes of the environment, at most"),
        numberRow("light-radius", kLightRadiusRange, &S::getLightRadius, &S::setLightRadius,
                  "Radius of the spheres that point and spot lights become [length]"),
        numberRow("light-angle", kLightAngleRange, &S::getLightAngle, &S::setLightAngle,
                  "Angular diameter of directional lights [degrees]; the sun: 0.53"),
        textRow("light-sizes", "none|NAME=0.2", &S::getLightSizes, &S::setLightSizes, areLightSizes,
                "Radius or angle of single lights, by their names"),
        switchRow("shadows", &S::getShadows, &S::setShadows, "Shadows of all lights"),
        switchRow("terminator-correction", &S::getTerminatorCorrection, &S::setTerminatorCorrection,
                  "No step where light ends on smooth-shaded facets"),
        numberRow("max-bounces", kMaxBouncesRange, &S::getMaxBounces, &S::setMaxBounces,
                  "Edges of a path after the camera ray"),
        numberRow("max-passes", kMaxPassesRange, &S::getMaxPasses, &S::setMaxPasses,
                  "Passes after which an unchanged image is done"),
        numberRow("passes-per-frame", kPassesPerFrameRange, &S::getPassesPerFrame,
                  &S::setPassesPerFrame, "Passes traced in each frame of a viewer"),
        numberRow("threads", kThreadsRange, &S::getThreads, &S::setThreads,
                  "Threads, the calling one included; 0: all of the machine"),
        numberRow("seed", kSeedRange, &S::getSeed, &S::setSeed, "Equal seeds give equal images"),
        numberRow("exposure", kExposureRange, &S::getExposure, &S::setExposure,
                  "Exposure [EV]: radiance times 2^value before display"),
        choiceRow(
            "color-rule", kColorRuleWords, &S::getColorRule, &S::setColorRule,
            "Whether colours are used as they are or decoded from sRGB; auto: by the materials"),
        numberRow("photons", kPhotonsRange, &S::getPhotons, &S::setPhotons,
                  "Photons emitted a pass by ppm, sppm and photon-caustics"),
        numberRow("photon-radius", kPhotonRadiusRange, &S::getPhotonRadius, &S::setPhotonRadius,
                  "Radius of photon lookups in the first pass [length]; 0: by their density"),
        numberRow("photon-alpha", kPhotonAlphaRange, &S::getPhotonAlpha, &S::setPhotonAlpha,
                  "Share of new photons that a pass keeps: how fast the radius shrinks"),
        choiceRow("radius-schedule", kRadiusScheduleWords, &S::getRadiusSchedule,
                  &S::setRadiusSchedule,
                  "Radii shrink by the number of the pass, or by the photons of each pixel"),
        switchRow("aim-at-views", &S::getAimAtViews, &S::setAimAtViews,
                  "Photons for mirrors and glass go where the views see their light"),
        textRow("materials", "none|FILE", &S::getMaterials, &S::setMaterials, isAnything,
                "JSON file of physical materials by names in the model"),
        choiceRow("debug-channel", kDebugChannelWords, &S::getDebugChannel, &S::setDebugChannel,
                  "What the debug integrator shows"),
    };
    return table;
}

/// Null if there is no such option.
const OptionRow* findRow(const std::string& name)
{
    const std::string plain = plainName(name);
    const std::string wanted = plain == "passes" ? "maxpasses" : plain;
    for (const OptionRow& row : optionTable())
    {
        if (plainName(row.option.name) == wanted) return &row;
    }
    return nullptr;
}

template <typename T> void change(T& member, T value, unsigned int& modifiedCount)
{
    if (member == value) return;
    member = value;
    ++modifiedCount;
}

/// Out of range: the nearest value; NaN: the value that it had.
template <typename T>
void changeNumber(const char* name, const Range<T>& range, T& member, T value,
                  unsigned int& modifiedCount)
{
    if (!range.contains(value))
    {
        warnOnce(std::string(name) + " " + textOf(value) + " is not in " + textOf(range.minimum) +
                 " .. " + textOf(range.maximum));
        if (value != value) return;
    }
    change(member, std::clamp(value, range.minimum, range.maximum), modifiedCount);
}

/// Not an enumerator: ignored.
template <typename T>
void changeChoice(const char* name, const Words& words, T& member, T value,
                  unsigned int& modifiedCount)
{
    const long long index = static_cast<long long>(value);
    if (index < 0 || index >= static_cast<long long>(words.size()))
    {
        warnOnce(std::string(name) + ": there is no value number " + textOf(index));
        return;
    }
    change(member, value, modifiedCount);
}

} // namespace

RayTraceSettings::RayTraceSettings()
{
    for (const OptionRow& row : optionTable())
    {
        const char* text = std::getenv(row.option.environment.c_str());
        if (!text || row.set(*this, text)) continue;
        warnOnce("environment variable " + row.option.environment + ": '" + text +
                 "' is not one of " + row.option.range + "; ignored");
    }
    _modifiedCount = 0;
}

RayTraceSettings::RayTraceSettings(WithoutEnvironment) {}

RayTraceSettings::RayTraceSettings(const RayTraceSettings& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop),
      _integrator(other._integrator),
      _lightSampling(other._lightSampling),
      _debugChannel(other._debugChannel),
      _colorRule(other._colorRule),
      _lightSamples(other._lightSamples),
      _environmentSampling(other._environmentSampling),
      _environmentSamples(other._environmentSamples),
      _lightRadius(other._lightRadius),
      _lightAngle(other._lightAngle),
      _lightSizes(other._lightSizes),
      _maxBounces(other._maxBounces),
      _shadows(other._shadows),
      _terminatorCorrection(other._terminatorCorrection),
      _maxPasses(other._maxPasses),
      _passesPerFrame(other._passesPerFrame),
      _threads(other._threads),
      _seed(other._seed),
      _exposure(other._exposure),
      _photons(other._photons),
      _photonRadius(other._photonRadius),
      _photonAlpha(other._photonAlpha),
      _radiusSchedule(other._radiusSchedule),
      _aimAtViews(other._aimAtViews),
      _materials(other._materials)
{
}

RayTraceSettings::~RayTraceSettings() = default;

void RayTraceSettings::setIntegrator(Integrator value)
{
    changeChoice("integrator", kIntegratorWords, _integrator, value, _modifiedCount);
}

void RayTraceSettings::setLightSampling(LightSampling value)
{
    changeChoice("light-sampling", kLightSamplingWords, _lightSampling, value, _modifiedCount);
}

void RayTraceSettings::setEnvironmentSampling(EnvironmentSampling value)
{
    changeChoice("environment-sampling", kEnvironmentSamplingWords, _environmentSampling, value,
                 _modifiedCount);
}

void RayTraceSettings::setEnvironmentSamples(int value)
{
    changeNumber("environment-samples", kEnvironmentSamplesRange, _environmentSamples, value,
                 _modifiedCount);
}

void RayTraceSettings::setDebugChannel(DebugChannel value)
{
    changeChoice("debug-channel", kDebugChannelWords, _debugChannel, value, _modifiedCount);
}

void RayTraceSettings::setColorRule(ColorRule value)
{
    changeChoice("color-rule", kColorRuleWords, _colorRule, value, _modifiedCount);
}

void RayTraceSettings::setLightSamples(int value)
{
    changeNumber("light-samples", kLightSamplesRange, _lightSamples, value, _modifiedCount);
}

void RayTraceSettings::setLightRadius(float value)
{
    changeNumber("light-radius", kLightRadiusRange, _lightRadius, value, _modifiedCount);
}

void RayTraceSettings::setLightAngle(float value)
{
    changeNumber("light-angle", kLightAngleRange, _lightAngle, value, _modifiedCount);
}

void RayTraceSettings::setLightSizes(const std::string& value)
{
    if (!areLightSizes(value))
        warnOnce("light-sizes '" + value + "' are not NAME=SIZE,...; ignored");
    else
        change(_lightSizes, value.empty() ? std::string("none") : value, _modifiedCount);
}

void RayTraceSettings::setMaxBounces(int value)
{
    changeNumber("max-bounces", kMaxBouncesRange, _maxBounces, value, _modifiedCount);
}

void RayTraceSettings::setShadows(bool value)
{
    change(_shadows, value, _modifiedCount);
}

void RayTraceSettings::setTerminatorCorrection(bool value)
{
    change(_terminatorCorrection, value, _modifiedCount);
}

void RayTraceSettings::setAimAtViews(bool value)
{
    change(_aimAtViews, value, _modifiedCount);
}

void RayTraceSettings::setMaxPasses(int value)
{
    changeNumber("max-passes", kMaxPassesRange, _maxPasses, value, _modifiedCount);
}

void RayTraceSettings::setPassesPerFrame(int value)
{
    changeNumber("passes-per-frame", kPassesPerFrameRange, _passesPerFrame, value, _modifiedCount);
}

void RayTraceSettings::setThreads(int value)
{
    changeNumber("threads", kThreadsRange, _threads, value, _modifiedCount);
}

void RayTraceSettings::setSeed(unsigned int value)
{
    change(_seed, value, _modifiedCount);
}

void RayTraceSettings::setExposure(float value)
{
    changeNumber("exposure", kExposureRange, _exposure, value, _modifiedCount);
}

void RayTraceSettings::setPhotons(int value)
{
    changeNumber("photons", kPhotonsRange, _photons, value, _modifiedCount);
}

void RayTraceSettings::setPhotonRadius(float value)
{
    changeNumber("photon-radius", kPhotonRadiusRange, _photonRadius, value, _modifiedCount);
}

void RayTraceSettings::setPhotonAlpha(float value)
{
    changeNumber("photon-alpha", kPhotonAlphaRange, _photonAlpha, value, _modifiedCount);
}

void RayTraceSettings::setRadiusSchedule(RadiusSchedule value)
{
    changeChoice("radius-schedule", kRadiusScheduleWords, _radiusSchedule, value, _modifiedCount);
}

void RayTraceSettings::setMaterials(const std::string& value)
{
    change(_materials, value.empty() ? std::string("none") : value, _modifiedCount);
}

std::string RayTraceSettings::getMaterialsError() const
{
    return _materials == "none" ? std::string() : engine::readMaterialLibrary(_materials).error;
}

std::vector<RayTraceSettings::Option> RayTraceSettings::options()
{
    const osg::ref_ptr<RayTraceSettings> defaults = new RayTraceSettings(WithoutEnvironment());
    std::vector<Option> list;
    for (const OptionRow& row : optionTable())
    {
        list.push_back(row.option);
        list.back().defaultValue = row.get(*defaults);
    }
    return list;
}

bool RayTraceSettings::set(const std::string& name, const std::string& value)
{
    const OptionRow* row = findRow(name);
    return row && row->set(*this, value);
}

std::string RayTraceSettings::get(const std::string& name) const
{
    const OptionRow* row = findRow(name);
    return row ? row->get(*this) : std::string();
}

} // namespace osgRayTrace
