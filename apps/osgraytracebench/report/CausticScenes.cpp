// CausticScenes.cpp - builds the mirrors, and computes their caustics. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/CausticScenes.h"

#include "data/generator/Surfaces.h"

#include <osg/Geometry>
#include <osg/LightSource>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kBounces = 8;
constexpr float kAlbedo = 0.5f;
const Vec3d kLamp(1.0, 0.3, 1.2); ///< over the floor z = 0, before the mirror x = 0

/// Returns a lamp of diffuse 1: an irradiance of pi at distance 1, or across the light if position
/// is a direction.
osg::ref_ptr<osg::LightSource> lamp(const osg::Vec4& position)
{
    osg::ref_ptr<osg::Light> light = new osg::Light(1);
    light->setPosition(position);
    light->setAmbient(osg::Vec4(0, 0, 0, 1));
    light->setDiffuse(osg::Vec4(1, 1, 1, 1));
    light->setSpecular(osg::Vec4(0, 0, 0, 1));
    if (position.w() != 0.0f)
    {
        light->setConstantAttenuation(0.0f);
        light->setQuadraticAttenuation(1.0f);
    }
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setLight(light.get());
    return source;
}

osg::ref_ptr<osg::Group> litFloor(const std::string& name, const data::Quad& floor,
                                  const osg::Vec4& light)
{
    const osg::ref_ptr<osg::Group> graph = data::newGraph(name);
    const osg::ref_ptr<PhysicalMaterial> grey = data::lambert(Vec3(kAlbedo, kAlbedo, kAlbedo));
    graph->addChild(data::surface("floor", {floor}, grey.get()).get());
    graph->addChild(lamp(light).get());
    graph->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    return graph;
}

/// Returns irradiance / pi on the floor from a lamp of intensity pi.
double pointIrradiance(const Vec3d& light, const Vec3d& point)
{
    const Vec3d towards = light - point;
    return towards.z() / (towards.length2() * towards.length());
}

// The nephroid is made by an arc of radius 1 around the origin, |phi| at most kArc, as high as
// light falls while it crosses the radius. A floor point reached from the wall's azimuth phi after
// a run of s is (cos phi, sin phi) - s (cos 2 phi, sin 2 phi), 0 <= s <= 1; the light that falls on
// dphi ds is cos phi times the floor's direct irradiance. No chord of the arc is shorter than 1: no
// light meets the wall twice.
constexpr double kArc = M_PI / 3.0;
constexpr double kHeight = 0.5;
const double kFall = std::atan(kHeight); ///< angle of the light below the horizon
constexpr double kCentre = 0.48,
                 kHalf = 0.38; ///< the square that is seen, along x; its centre along y is 0

osg::ref_ptr<osg::Geode> arcMirror()
{
    constexpr int kColumns = 2048; // facets leave the arc by 1.3e-7
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    for (int c = 0; c <= kColumns; ++c)
    {
        const double phi = kArc * (2.0 * c / kColumns - 1.0);
        for (const double z : {0.0, kHeight})
        {
            positions->push_back(Vec3d(std::cos(phi), std::sin(phi), z));
            normals->push_back(Vec3d(-std::cos(phi), -std::sin(phi), 0.0));
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions.get());
    geometry->setNormalArray(normals.get(), osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(
        new osg::DrawArrays(GL_QUAD_STRIP, 0, static_cast<int>(positions->size())));
    osg::ref_ptr<osg::Geode> node = new osg::Geode;
    node->setName("arc");
    node->getOrCreateStateSet()->setAttribute(data::mirror().get());
    node->addDrawable(geometry.get());
    return node;
}

/// Returns the light of a lattice of (phi, s) counted in the pixels where it lands: the mean over
/// each pixel, also over those with the caustic in them, in which the irradiance itself is
/// infinite.
std::vector<double> nephroidPicture(int width, int height, const engine::Workers& workers)
{
    constexpr std::size_t kRows = 512, kPointsARow = 1 << 16;
    constexpr double kGolden[2] = {0.7548776662466927,
                                   0.5698402909980532}; // steps of an even lattice
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<std::vector<double>> parts(16, std::vector<double>(pixels, 0.0));
    const auto part = [&](std::size_t p)
    {
        for (std::size_t i = p * kRows * kPointsARow / parts.size();
             i < (p + 1) * kRows * kPointsARow / parts.size(); ++i)
        {
            const double u = static_cast<double>(i) * kGolden[0],
                         v = static_cast<double>(i) * kGolden[1];
            const double phi = kArc * (2.0 * (u - std::floor(u)) - 1.0), s = v - std::floor(v);
            const double x = std::cos(phi) - s * std::cos(2.0 * phi);
            const double y = std::sin(phi) - s * std::sin(2.0 * phi);
            const double column = 0.5 * width * ((x - kCentre) / kHalf + 1.0);
            const double row = 0.5 * height * (y / kHalf + 1.0);
            if (!(column >= 0.0 && column < width && row >= 0.0 && row < height)) continue;
            parts[p][static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(column)] += std::cos(phi);
        }
    };
    workers.forEach(parts.size(), part);
    const double pixelArea = 4.0 * kHalf * kHalf / static_cast<double>(pixels);
    const double weight = 2.0 * kArc / static_cast<double>(kRows * kPointsARow) / pixelArea;
    const double direct = static_cast<double>(kAlbedo) * std::sin(kFall);
    std::vector<double> radiance(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i)
    {
        double reflected = 0.0;
        for (const std::vector<double>& sums : parts)
            reflected += sums[i];
        for (std::size_t c = 0; c < 3; ++c)
            radiance[3 * i + c] = direct * (1.0 + weight * reflected);
    }
    return radiance;
}

} // namespace

double flatMirrorIrradiance(double x, double y)
{
    return pointIrradiance(Vec3d(-kLamp.x(), kLamp.y(), kLamp.z()), Vec3d(x, y, 0.0));
}

ReportScene flatMirrorScene()
{
    ReportScene scene;
    scene.name = "s6-flat-mirror";
    scene.title = "S6: a floor lit by way of a flat mirror, seen in the mirror";
    const data::Quad floor{Vec3(0.05f, -2, 0), Vec3(4, -2, 0), Vec3(4, 4, 0), Vec3(0.05f, 4, 0)};
    const data::Quad wall{Vec3(0, -4, 0.01f), Vec3(0, 5, 0.01f), Vec3(0, 5, 3), Vec3(0, -4, 3)};
    scene.graph = litFloor("flat mirror", floor, osg::Vec4(Vec3(kLamp), 1.0f));
    scene.graph->asGroup()->addChild(data::surface("mirror", {wall}, data::mirror().get()).get());
    scene.view = osg::Matrixd::lookAt(Vec3d(0.8, -0.5, 1.6), Vec3d(0.0, -0.1, 0.9), Vec3d(0, 0, 1));
    scene.projection = osg::Matrixd::perspective(22.0, 1.0, 0.01, 100.0);
    scene.methods = photonMethods(kBounces, true);
    scene.placements = {atOrigin(), displaced()};
    scene.formula = [](const Vec3d& origin, const Vec3d& direction)
    {
        const Vec3d point = origin - direction * (origin.z() / direction.z());
        const Vec3d seen(-point.x(), point.y(), 0.0);
        const double radiance =
            static_cast<double>(kAlbedo) *
            (pointIrradiance(kLamp, seen) + flatMirrorIrradiance(seen.x(), seen.y()));
        return Vec3d(radiance, radiance, radiance);
    };
    return scene;
}

ReportScene nephroidScene()
{
    ReportScene scene;
    scene.name = "s7-nephroid";
    scene.title = "S7: the caustic of an arc in light of one direction";
    const data::Quad floor{Vec3(-0.2f, -0.7f, 0), Vec3(1.1f, -0.7f, 0), Vec3(1.1f, 0.7f, 0),
                           Vec3(-0.2f, 0.7f, 0)};
    const auto across = static_cast<float>(-std::cos(kFall));
    const auto down = static_cast<float>(std::sin(kFall));
    scene.graph = litFloor("nephroid", floor, osg::Vec4(across, 0.0f, down, 0.0f));
    scene.graph->asGroup()->addChild(arcMirror().get());
    scene.view = osg::Matrixd::lookAt(Vec3d(kCentre, 0, 2), Vec3d(kCentre, 0, 0), Vec3d(0, 1, 0));
    scene.projection = osg::Matrixd::ortho(-kHalf, kHalf, -kHalf, kHalf, 0.01, 10.0);
    scene.methods = photonMethods(kBounces, true);
    scene.placements = {atOrigin(), displaced()};
    scene.pictureFormula = nephroidPicture;
    return scene;
}

} // namespace osgRayTrace::bench
