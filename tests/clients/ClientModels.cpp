// ClientModels.cpp - writes the models that OSG's examples need and its sample data lacks: a paged
// database, a terrain, a sequence and a model that OSG is hinted to draw. Layer: tests.
// SPDX-License-Identifier: MIT
//
// Usage: clientModels FOLDER. The models refer to files of OSG's sample data.
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Sequence>
#include <osg/Shape>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgTerrain/GeometryTechnique>
#include <osgTerrain/Layer>
#include <osgTerrain/Terrain>
#include <osgTerrain/TerrainTile>

#include <cmath>
#include <string>

namespace
{

const char* const kModels[] = {"cow.osgt", "cessna.osgt", "glider.osgt", "dumptruck.osgt"};
constexpr int kSide = 32; ///< heights of a tile's side

/// Four models that are paged in where the axes are near.
osg::ref_ptr<osg::Group> paged()
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    for (int i = 0; i < 4; ++i)
    {
        osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
        lod->setCenter(osg::Vec3());
        lod->setRadius(15.0f);
        lod->addChild(osgDB::readRefNodeFile("axes.osgt"), 200.0f, 1e6f);
        lod->setFileName(1, kModels[i]);
        lod->setRange(1, 0.0f, 200.0f);
        osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(i % 2 * 30.0, i / 2 * 30.0, 0.0));
        place->addChild(lod);
        root->addChild(place);
    }
    return root;
}

osg::ref_ptr<osgTerrain::TerrainTile> tile(int column, int row)
{
    const double left = column * (kSide - 1), bottom = row * (kSide - 1);
    osg::ref_ptr<osgTerrain::Locator> locator = new osgTerrain::Locator;
    locator->setCoordinateSystemType(osgTerrain::Locator::PROJECTED);
    locator->setTransformAsExtents(left, bottom, left + kSide - 1, bottom + kSide - 1);
    osg::ref_ptr<osg::HeightField> heights = new osg::HeightField;
    heights->allocate(kSide, kSide);
    heights->setOrigin(osg::Vec3(float(left), float(bottom), 0.0f));
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            heights->setHeight(
                unsigned(x), unsigned(y),
                float(4.0 * std::sin(0.2 * (x + left)) * std::cos(0.15 * (y + bottom))));
    osg::ref_ptr<osgTerrain::TerrainTile> tile = new osgTerrain::TerrainTile;
    tile->setTileID(osgTerrain::TileID(1, column, row));
    tile->setLocator(locator);
    osg::ref_ptr<osgTerrain::Layer> elevation = new osgTerrain::HeightFieldLayer(heights);
    elevation->setLocator(locator);
    tile->setElevationLayer(elevation);
    osg::ref_ptr<osgTerrain::Layer> color =
        new osgTerrain::ImageLayer(osgDB::readRefImageFile("Images/lz.rgb"));
    color->setLocator(locator);
    tile->setColorLayer(0, color);
    tile->setTerrainTechnique(new osgTerrain::GeometryTechnique);
    return tile;
}

osg::ref_ptr<osgTerrain::Terrain> terrain()
{
    osg::ref_ptr<osgTerrain::Terrain> terrain = new osgTerrain::Terrain;
    for (int i = 0; i < 4; ++i)
        terrain->addChild(tile(i % 2, i / 2));
    return terrain;
}

/// Trucks that OSG is hinted to draw.
osg::ref_ptr<osg::Group> rasterized()
{
    const osg::ref_ptr<osg::Node> truck = osgDB::readRefNodeFile("dumptruck.osgt");
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addDescription("osgRayTrace:rasterize");
    for (int i = 0; i < 9; ++i)
    {
        osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(i % 3 * 30.0, i / 3 * 30.0, 0.0));
        place->addChild(truck);
        root->addChild(place);
    }
    return root;
}

osg::ref_ptr<osg::Sequence> sequence()
{
    osg::ref_ptr<osg::Sequence> sequence = new osg::Sequence;
    for (const char* model : kModels)
        sequence->addChild(osgDB::readRefNodeFile(model), 0.5);
    sequence->setInterval(osg::Sequence::LOOP, 0, -1);
    sequence->setDuration(1.0f, -1);
    sequence->setMode(osg::Sequence::START);
    return sequence;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) return 1;
    const std::string folder = std::string(argv[1]) + '/';
    const bool written = osgDB::writeNodeFile(*paged(), folder + "paged.osgt") &&
                         osgDB::writeNodeFile(*terrain(), folder + "terrain.osgt") &&
                         osgDB::writeNodeFile(*rasterized(), folder + "rasterized.osgt") &&
                         osgDB::writeNodeFile(*sequence(), folder + "sequence.osgt");
    return written ? 0 : 1;
}
