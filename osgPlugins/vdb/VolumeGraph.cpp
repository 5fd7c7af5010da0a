// VolumeGraph.cpp - makes smoke and isosurfaces. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/vdb/VolumeGraph.h"

#include <osgRayTrace/Medium>
#include <osgRayTrace/PhysicalMaterial>

#include <osgVolume/Property>
#include <osgVolume/RayTracedTechnique>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::vdb
{

namespace
{

constexpr double kDepthAlongLongestSide = 10.0;
constexpr float kAlbedo = 0.95f, kAnisotropy = 0.3f;

/// A value below 0 is nothing; it stays below 0 by at most this much of the largest value.
constexpr double kMostBelow = 1e12;

/// What OSG shows are opacities of samples, so far apart in a box of unit length. Below the least
/// one a tile would not be seen at all.
constexpr double kSampleStep = 1.0 / 256.0, kLeastOpacity = 1e-3;

/// Returns the lengths of a cell's sides.
osg::Vec3d cellSides(const VdbDense& dense, const osg::Matrixd& worldFromIndex)
{
    osg::Vec3d sides;
    for (int k = 0; k < 3; ++k)
        sides[k] =
            static_cast<double>(dense.factor) *
            osg::Vec3d(worldFromIndex(k, 0), worldFromIndex(k, 1), worldFromIndex(k, 2)).length();
    return sides;
}

/// Divides the image by its largest value. Sets the mean of what was above 0, and returns the
/// largest value.
double normalize(osg::Image& image, double& mean)
{
    auto* const begin = reinterpret_cast<float*>(image.data());
    auto* const end =
        begin + std::size_t(image.s()) * std::size_t(image.t()) * std::size_t(image.r());
    const float largest = *std::max_element(begin, end);
    if (!(largest > 0.0f)) throw VdbError("it has no value above 0");
    double sum = 0.0, count = 0.0;
    for (float* value = begin; value != end; ++value)
    {
        if (*value > 0.0f)
        {
            sum += double(*value);
            count += 1.0;
        }
        *value = static_cast<float>(std::max(double(*value) / double(largest), -kMostBelow));
    }
    mean = sum / count;
    return double(largest);
}

/// Makes a tile smoke for rays, and a tile of opacities for OpenGL.
void setSmoke(osgVolume::VolumeTile& tile, osgVolume::ImageLayer& layer, const osg::Vec3d& cell,
              std::optional<double> extinction)
{
    osg::Image& image = *layer.getImage();
    double mean = 0.0;
    const double largest = normalize(image, mean);
    layer.setTexelScale(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f) * static_cast<float>(largest));
    const double longest =
        std::max({cell.x() * image.s(), cell.y() * image.t(), cell.z() * image.r()});
    const double ofLargest =
        largest * (extinction ? *extinction : kDepthAlongLongestSide / (mean * longest));

    // OSG takes samples at steps of the box's own lengths, and their opacities as they are.
    const double step =
        std::cbrt(cell.x() * cell.y() * cell.z() * image.s() * image.t() * image.r()) * kSampleStep;
    const double opacity = std::max(-std::expm1(-ofLargest * step), kLeastOpacity);
    layer.addProperty(new osgVolume::AlphaFuncProperty(0.0f));
    layer.addProperty(new osgVolume::SampleDensityProperty(static_cast<float>(kSampleStep)));
    layer.addProperty(new osgVolume::TransparencyProperty(static_cast<float>(opacity)));

    // Rays multiply the coefficients by values and by this opacity, which is thus to be taken out.
    const auto coefficient = static_cast<float>(std::min(ofLargest / opacity, 1e30));
    const osg::ref_ptr<Medium> medium = new Medium;
    medium->setScattering(osg::Vec3(1.0f, 1.0f, 1.0f) * (kAlbedo * coefficient));
    medium->setAbsorption(osg::Vec3(1.0f, 1.0f, 1.0f) * ((1.0f - kAlbedo) * coefficient));
    medium->setAnisotropy(kAnisotropy);
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setInterior(medium.get());
    tile.getOrCreateStateSet()->setAttribute(material.get());
}

} // namespace

osg::ref_ptr<osgVolume::VolumeTile> volumeTile(const VdbDense& dense, const VdbGrid& grid,
                                               std::optional<double> extinction)
{
    osg::Image& image = *dense.image;
    const auto factor = static_cast<double>(dense.factor);
    // Voxel (i, j, k) fills the cube around the index (i, j, k).
    const osg::Vec3d corner(double(dense.low[0]) - 0.5, double(dense.low[1]) - 0.5,
                            double(dense.low[2]) - 0.5);
    const osg::Matrixd worldFromCube =
        osg::Matrixd::scale(factor * image.s(), factor * image.t(), factor * image.r()) *
        osg::Matrixd::translate(corner) * grid.worldFromIndex;

    const osg::ref_ptr<osgVolume::ImageLayer> layer = new osgVolume::ImageLayer(&image);
    const osg::ref_ptr<osgVolume::VolumeTile> tile = new osgVolume::VolumeTile;
    layer->setLocator(new osgVolume::Locator(worldFromCube));
    if (grid.isLevelSet)
        layer->addProperty(new osgVolume::IsoSurfaceProperty(0.5f));
    else
        setSmoke(*tile, *layer, cellSides(dense, grid.worldFromIndex), extinction);
    tile->setLayer(layer.get());
    tile->setLocator(layer->getLocator());
    tile->setVolumeTechnique(new osgVolume::RayTracedTechnique);
    return tile;
}

} // namespace osgRayTrace::vdb
