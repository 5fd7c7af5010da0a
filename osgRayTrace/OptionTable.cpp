// OptionTable.cpp - the table of options, and how they are read from text. Layer: public API.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/OptionTable.h"

#include "osgRayTrace/FormerOptions.h"
#include "osgRayTrace/base/NeverDestroyed.h"
#include "osgRayTrace/base/NumberText.h"
#include "osgRayTrace/bridge/appearance/lights/LightSizes.h"
#include "osgRayTrace/bridge/common/GroundRequest.h"
#include "osgRayTrace/servers/ServerAddresses.h"

#include <algorithm>

namespace osgRayTrace
{

namespace
{

constexpr std::string_view kSwitchWords[] = {"false", "true"};

/// Returns the name in lower case without dashes and underscores: "light-samples", "LIGHT_SAMPLES"
/// and "lightSamples" agree.
std::string plainName(std::string_view name)
{
    std::string plain;
    for (char c : name)
    {
        if (c == '-' || c == '_') continue;
        plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return plain;
}

/// Sets value if all of the text is one number within the range, else returns false.
template <typename T> bool parseWithin(const std::string& text, const Range<T>& range, T& value)
{
    const std::optional<T> number = engine::parseNumber<T>(text);
    if (!number || !range.contains(*number)) return false;
    value = *number;
    return true;
}

RayTraceSettings::Option describe(const std::string& name, const std::string& range,
                                  const std::string& help)
{
    const std::string former(formerNameOf(name));
    return {name, environmentName(name), std::string(), range, help, former};
}

template <typename T>
OptionRow numberRow(const std::string& name, const Range<T>& range,
                    T (RayTraceSettings::*get)() const, void (RayTraceSettings::*set)(T),
                    const std::string& help)
{
    OptionRow row;
    row.option = describe(
        name, engine::numberText(range.minimum) + " .. " + engine::numberText(range.maximum), help);
    row.get = [get](const RayTraceSettings& settings)
    { return engine::numberText((settings.*get)()); };
    row.set = [range, set](RayTraceSettings& settings, const std::string& text)
    {
        T value{};
        if (!parseWithin(text, range, value)) return false;
        (settings.*set)(value);
        return true;
    };
    return row;
}

template <typename T>
OptionRow choiceRow(const std::string& name, Words words, T (RayTraceSettings::*get)() const,
                    void (RayTraceSettings::*set)(T), const std::string& help)
{
    std::string range;
    for (const std::string_view word : words)
    {
        if (!range.empty()) range += '|';
        range += word;
    }

    OptionRow row;
    row.option = describe(name, range, help);
    row.get = [words, get](const RayTraceSettings& settings)
    { return std::string(words.begin()[static_cast<size_t>((settings.*get)())]); };
    row.set = [words, set](RayTraceSettings& settings, const std::string& text)
    {
        const auto isMeant = [&text](std::string_view word)
        { return plainName(word) == plainName(text); };
        const auto found = std::find_if(words.begin(), words.end(), isMeant);
        if (found == words.end()) return false;
        (settings.*set)(static_cast<T>(found - words.begin()));
        return true;
    };
    return row;
}

/// Returns the row of an option that is true or false; its text may also be 0 and 1, off and on, no
/// and yes.
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

/// Returns the row of an option that takes any text for which isGood is true.
OptionRow textRow(const std::string& name, const std::string& range,
                  const std::string& (RayTraceSettings::*get)() const,
                  void (RayTraceSettings::*set)(const std::string&),
                  bool (*isGood)(const std::string&), const std::string& help)
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

} // namespace

bool areLightSizes(const std::string& text)
{
    return engine::parseLightSizes(text).has_value();
}

bool isGround(const std::string& text)
{
    return engine::parseGround(text).has_value();
}

bool areServers(const std::string& text)
{
    return engine::parseServers(text).has_value();
}

const std::vector<OptionRow>& optionTable()
{
    using S = RayTraceSettings;
    static const engine::NeverDestroyed<std::vector<OptionRow>> table(std::vector<OptionRow>{
        choiceRow("integrator", kIntegratorWords, &S::getIntegrator, &S::setIntegrator,
                  "How light is computed; auto: whitted for fixed-function scenes, path for "
                  "physical ones, photon-caustics for those with metal or glass"),
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
        switchRow("headlight-shadows", &S::getHeadlightShadows, &S::setHeadlightShadows,
                  "Shadows of the viewer's headlight, which comes from behind the eye, too"),
        switchRow("terminator-correction", &S::getTerminatorCorrection, &S::setTerminatorCorrection,
                  "No step where light ends on smooth-shaded facets"),
        switchRow("cull-all-rays", &S::getCullAllRays, &S::setCullAllRays,
                  "All rays pass faces that they meet on the culled side; else camera rays alone"),
        choiceRow("fog", kFogWords, &S::getFog, &S::setFog,
                  "What osg::Fog is: as OpenGL draws it, or a medium that the lights light"),
        textRow("ground", "none|auto|1.5", &S::getGround, &S::setGround, isGround,
                "A plane that shows nothing but shadows on it: right below the model (auto), or at "
                "a height"),
        numberRow("point-radius", kPointRadiusRange, &S::getPointRadius, &S::setPointRadius,
                  "Radius of points and lines, traced as spheres and capsules [length]; 0: OSG "
                  "draws them"),
        numberRow("max-bounces", kMaxBouncesRange, &S::getMaxBounces, &S::setMaxBounces,
                  "Edges of a path after the camera ray"),
        numberRow("max-passes", kMaxPassesRange, &S::getMaxPasses, &S::setMaxPasses,
                  "Passes after which an unchanged image is done"),
        numberRow("frame-budget", kFrameBudgetRange, &S::getFrameBudget, &S::setFrameBudget,
                  "Time for each view in each frame of a viewer [ms]; 0: passes-per-frame decides"),
        switchRow("degrade-while-moving", &S::getDegradeWhileMoving, &S::setDegradeWhileMoving,
                  "The frame budget may reduce the resolution of moving views"),
        switchRow("equal-views", &S::getEqualViews, &S::setEqualViews,
                  "All views of a scene take the same passes and resolution in a frame, and share "
                  "the frame "
                  "budget: for CAVEs"),
        numberRow("passes-per-frame", kPassesPerFrameRange, &S::getPassesPerFrame,
                  &S::setPassesPerFrame, "Passes in each frame of a viewer without a frame budget"),
        choiceRow("presentation", kPresentationWords, &S::getPresentation, &S::setPresentation,
                  "Viewers trace each frame, or show the newest image that a worker has made"),
        switchRow("reproject", &S::getReproject, &S::setReproject,
                  "A view that moves takes along what its image has accumulated"),
        switchRow(
            "keep-unchanged", &S::getKeepUnchanged, &S::setKeepUnchanged,
            "A view at rest keeps what nothing near has changed, if little in the scene does"),
        numberRow("threads", kThreadsRange, &S::getThreads, &S::setThreads,
                  "Threads, the calling one included; 0: all of the machine"),
        numberRow("seed", kSeedRange, &S::getSeed, &S::setSeed, "Equal seeds give equal images"),
        numberRow("aperture", kApertureRange, &S::getAperture, &S::setAperture,
                  "Diameter of the lens of perspective views [length]; 0: all is sharp"),
        numberRow("focus", kFocusRange, &S::getFocus, &S::setFocus,
                  "Distance that the lens shows sharp [length]; 0: what is straight ahead"),
        numberRow("exposure", kExposureRange, &S::getExposure, &S::setExposure,
                  "Exposure [EV]: radiance times 2^value before display"),
        switchRow("auto-exposure", &S::getAutoExposure, &S::setAutoExposure,
                  "The mean of a picture is shown as middle grey; exposure adds to it"),
        choiceRow("tone-curve", kToneCurveWords, &S::getToneCurve, &S::setToneCurve,
                  "How bright radiance is shown: clamped, or by Khronos PBR Neutral or AgX"),
        choiceRow(
            "color-rule", kColorRuleWords, &S::getColorRule, &S::setColorRule,
            "Whether colours are used as they are or decoded from sRGB; auto: by the materials"),
        numberRow("photons", kPhotonsRange, &S::getPhotons, &S::setPhotons,
                  "Photons emitted a pass by ppm, sppm and photon-caustics"),
        numberRow("photon-beams", kPhotonBeamsRange, &S::getPhotonBeams, &S::setPhotonBeams,
                  "Photons of a pass that leave beams in fog and other media that scatter"),
        numberRow("photon-radius", kPhotonRadiusRange, &S::getPhotonRadius, &S::setPhotonRadius,
                  "Radius of photon lookups in the first pass [length]; 0: by their density"),
        numberRow("photon-alpha", kPhotonAlphaRange, &S::getPhotonAlpha, &S::setPhotonAlpha,
                  "Share of new photons that a pass keeps: how fast the radius shrinks"),
        choiceRow("radius-schedule", kRadiusScheduleWords, &S::getRadiusSchedule,
                  &S::setRadiusSchedule,
                  "Radii shrink by the number of the pass, or by the photons of each pixel"),
        switchRow(
            "photon-guiding", &S::getPhotonGuiding, &S::setPhotonGuiding,
            "Photons go where views see their light: to metal and glass, through small openings"),
        choiceRow("denoise", kDenoiseWords, &S::getDenoise, &S::setDenoise,
                  "Takes out the noise of few passes; oidn: by Open Image Denoise, where that is "
                  "built in"),
        textRow("materials", "none|FILE", &S::getMaterials, &S::setMaterials, isAnything,
                "JSON file of physical materials by names in the model"),
        textRow("servers", "none|tcp://HOST:7411", &S::getServers, &S::setServers, areServers,
                "Render servers that trace tiles of viewers' images, with commas between them"),
        choiceRow("debug-channel", kDebugChannelWords, &S::getDebugChannel, &S::setDebugChannel,
                  "What the debug integrator shows"),
    });
    return *table;
}

/// Returns the row of an option; null if there is no such option.
const OptionRow* findRow(const std::string& name)
{
    const std::string plain = plainName(name);
    const std::string wanted = plain == "passes" ? "maxpasses" : plain;
    for (const OptionRow& row : optionTable())
    {
        if (plainName(row.option.name) == wanted || isFormerName(row, name)) return &row;
    }
    return nullptr;
}

bool isFormerName(const OptionRow& row, const std::string& name)
{
    const std::string& former = row.option.formerName;
    return !former.empty() && plainName(former) == plainName(name);
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

} // namespace osgRayTrace
