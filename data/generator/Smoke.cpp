// Smoke.cpp - a column of smoke above a table, as a volume of 128^3 voxels. Part of the scene
// generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/Medium>

#include <osg/Image>
#include <osgVolume/MultipassTechnique>
#include <osgVolume/Property>
#include <osgVolume/VolumeTile>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kVoxels = 128;

/// Returns a number in [0,1) for a point of the lattice.
double lattice(int x, int y, int z)
{
    auto bits = static_cast<unsigned int>(x) * 0x8da6b343u +
                static_cast<unsigned int>(y) * 0xd8163841u +
                static_cast<unsigned int>(z) * 0xcb1ab31fu;
    bits ^= bits >> 13;
    bits *= 0x7feb352du;
    bits ^= bits >> 15;
    bits *= 0x846ca68bu;
    bits ^= bits >> 16;
    return bits / 4294967296.0;
}

/// Returns smooth noise in [0,1) whose bumps are about one long.
double noise(const Vec3d& p)
{
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y())),
              z = static_cast<int>(std::floor(p.z()));
    const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
    const double fx = smooth(p.x() - x), fy = smooth(p.y() - y), fz = smooth(p.z() - z);
    const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
    double slice[2];
    for (int k = 0; k < 2; ++k)
        slice[k] = mix(mix(lattice(x, y, z + k), lattice(x + 1, y, z + k), fx),
                       mix(lattice(x, y + 1, z + k), lattice(x + 1, y + 1, z + k), fx), fy);
    return mix(slice[0], slice[1], fz);
}

/// Returns noise of five octaves in [-1,1).
double turbulence(Vec3d p)
{
    double sum = 0.0, weight = 0.5;
    for (int octave = 0; octave < 5; ++octave, weight *= 0.5, p = p * 2.03 + Vec3d(7, 3, 5))
        sum += weight * (2.0 * noise(p) - 1.0);
    return sum;
}

/// Returns the density at a point of the unit cube, in which smoke rises along z: a column that
/// widens, and is bent and torn more the higher it is.
double density(const Vec3d& p)
{
    const double height = p.z();
    const Vec3d bent =
        p + Vec3d(turbulence(p * 3.0), turbulence(p * 3.0 + Vec3d(9, 1, 4)), 0.0) * (0.22 * height);
    const double width = 0.05 + 0.24 * height;
    const double x = bent.x() - 0.5, y = bent.y() - 0.5;
    const double inside = 1.0 - std::sqrt(x * x + y * y) / width;
    const double torn = turbulence(p * 7.0 + Vec3d(0, 0, 3)) * (0.4 + 1.2 * height);
    const double fade = std::min(1.0, 6.0 * (1.0 - height));
    return std::clamp((1.6 * inside + torn) * fade * (1.0 - 0.6 * height), 0.0, 1.0);
}

osg::ref_ptr<osg::Image> smokeImage()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(kVoxels, kVoxels, kVoxels, GL_LUMINANCE, GL_UNSIGNED_BYTE);
    image->setInternalTextureFormat(GL_LUMINANCE);
    for (int z = 0; z < kVoxels; ++z)
        for (int y = 0; y < kVoxels; ++y)
            for (int x = 0; x < kVoxels; ++x)
                *image->data(x, y, z) = static_cast<unsigned char>(
                    255.0 * density(Vec3d(x + 0.5, y + 0.5, z + 0.5) / kVoxels));
    return image;
}

} // namespace

osg::ref_ptr<osg::Group> smoke()
{
    const SceneView view{Vec3d(0.4, -4.2, 1.3), Vec3d(0, 0, 0.95), Vec3d(0, 0, 1), 34.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("smoke", view, view);
    scene->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    scene->addChild(surface("table",
                            {{Vec3(-8, -8, 0), Vec3(8, -8, 0), Vec3(8, 8, 0), Vec3(-8, 8, 0)},
                             {Vec3(-8, 5, 0), Vec3(8, 5, 0), Vec3(8, 5, 9), Vec3(-8, 5, 9)}},
                            lambert(Vec3(0.32f, 0.3f, 0.28f)).get()));
    scene->addChild(
        sphere("ember", Vec3(0, 0, 0.02f), 0.06f, lambert(Vec3(0.05f, 0.03f, 0.02f)).get()));
    scene->addChild(sun({-0.7f, -0.4f, 0.6f}, {3.2f, 2.9f, 2.5f}).get());

    const osg::ref_ptr<Medium> medium = new Medium; // of the densest voxels [1/m]
    medium->setScattering(Vec3(13.0f, 13.2f, 13.5f));
    medium->setAbsorption(Vec3(0.9f, 0.8f, 0.7f));
    medium->setAnisotropy(0.3f);
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setInterior(medium.get());
    const osg::ref_ptr<osgVolume::VolumeTile> tile = new osgVolume::VolumeTile;
    const osg::ref_ptr<osgVolume::ImageLayer> layer = new osgVolume::ImageLayer(smokeImage().get());
    layer->setLocator(new osgVolume::Locator(osg::Matrixd::scale(2.0, 2.0, 2.0) *
                                             osg::Matrixd::translate(-1.0, -1.0, 0.0)));
    layer->addProperty(new osgVolume::AlphaFuncProperty(0.0f));
    tile->setName("smoke");
    tile->setLayer(layer.get());
    tile->setLocator(layer->getLocator());
    tile->setVolumeTechnique(new osgVolume::MultipassTechnique);
    tile->getOrCreateStateSet()->setAttribute(material.get());
    scene->addChild(tile.get());
    return scene;
}

} // namespace osgRayTrace::data
