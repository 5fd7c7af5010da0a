// MovingScenes.cpp - a textured terrain and a town with traffic, made by formula. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/MovingScenes.h"

#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/Texture2D>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace osgRayTrace::bench
{

namespace
{

/// Returns a number in [0,1] for a point of a lattice.
double latticeNoise(int x, int y)
{
    uint32_t h = static_cast<uint32_t>(x) * 0x8da6b343u ^ static_cast<uint32_t>(y) * 0xd8163841u;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return ((h ^ (h >> 15)) & 0xffffu) / 65535.0;
}

double smoothNoise(double x, double y)
{
    const double fx = std::floor(x), fy = std::floor(y);
    const int i = static_cast<int>(fx), j = static_cast<int>(fy);
    const double u = x - fx, v = y - fy, s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
    const double low = latticeNoise(i, j) * (1 - s) + latticeNoise(i + 1, j) * s;
    const double high = latticeNoise(i, j + 1) * (1 - s) + latticeNoise(i + 1, j + 1) * s;
    return low * (1 - t) + high * t;
}

double fractalNoise(double x, double y, int octaves)
{
    double sum = 0.0, weight = 0.5;
    for (int k = 0; k < octaves; ++k, weight *= 0.5, x *= 2.03, y *= 2.03)
        sum += weight * smoothNoise(x, y);
    return sum;
}

constexpr double kTerrainSide = 2000.0; // [m]

double terrainHeight(double x, double y)
{
    return 260.0 * fractalNoise(0.004 * x, 0.004 * y, 5);
}

osg::ref_ptr<osg::Image> terrainImage()
{
    constexpr int kSide = 1024;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(kSide, kSide, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i)
        {
            const double x = kTerrainSide * (i + 0.5) / kSide, y = kTerrainSide * (j + 0.5) / kSide;
            const double rock = fractalNoise(0.01 * x + 50, 0.01 * y, 4);
            const double grain = 0.75 + 0.5 * fractalNoise(0.15 * x, 0.15 * y, 3);
            osg::Vec3d color = rock > 0.5 ? osg::Vec3d(0.55, 0.5, 0.45) : osg::Vec3d(0.3, 0.5, 0.2);
            const double road = std::fabs(std::fmod(x + 60 * std::sin(0.01 * y), 400.0) - 200.0);
            if (road < 8.0) color = osg::Vec3d(0.35, 0.35, 0.37);
            if (road < 1.0) color = osg::Vec3d(0.95, 0.95, 0.9);
            for (int c = 0; c < 3; ++c)
                image->data(i, j)[c] =
                    static_cast<unsigned char>(255.0 * std::min(1.0, color[c] * grain));
        }
    return image;
}

osg::ref_ptr<osg::LightSource> sun()
{
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->getLight()->setLightNum(1);
    source->getLight()->setPosition(osg::Vec4(-0.5f, -0.4f, 0.8f, 0.0f));
    source->getLight()->setDiffuse(osg::Vec4(0.6f, 0.6f, 0.55f, 1.0f));
    source->getLight()->setAmbient(osg::Vec4(0.2f, 0.2f, 0.25f, 1.0f));
    source->getLight()->setSpecular(osg::Vec4());
    return source;
}

osg::ref_ptr<osg::Group> groupInSun()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    group->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    group->getOrCreateStateSet()->setAttributeAndModes(material);
    group->addChild(sun());
    return group;
}

/// Collects coloured quads.
struct Quads
{
    void add(osg::Vec3 corner, osg::Vec3 u, osg::Vec3 v, osg::Vec4 color)
    {
        osg::Vec3 normal = u ^ v;
        normal.normalize();
        for (const osg::Vec3& point : {corner, corner + u, corner + u + v, corner + v})
        {
            vertices->push_back(point);
            normals->push_back(normal);
            colors->push_back(color);
        }
    }

    /// Adds a rectangle of the ground from (x0, y0) to (x1, y1) at a height.
    void addGround(double x0, double y0, double x1, double y1, double z, osg::Vec4 color)
    {
        add(osg::Vec3(x0, y0, z), osg::Vec3(x1 - x0, 0, 0), osg::Vec3(0, y1 - y0, 0), color);
    }

    void addBox(osg::Vec3 low, osg::Vec3 high, osg::Vec4 color)
    {
        const osg::Vec3 x(high.x() - low.x(), 0, 0), y(0, high.y() - low.y(), 0),
            z(0, 0, high.z() - low.z());
        add(low, x, z, color);
        add(low + y, -y, z, color);
        add(high - z, -x, z, color);
        add(high - z - y, y, z, color);
        add(low + z, x, y, color);
        add(low, y, x, color);
    }

    osg::ref_ptr<osg::Geometry> geometry() const
    {
        osg::ref_ptr<osg::Geometry> result = new osg::Geometry;
        result->setVertexArray(vertices);
        result->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
        result->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
        result->addPrimitiveSet(
            new osg::DrawArrays(GL_QUADS, 0, static_cast<GLsizei>(vertices->size())));
        return result;
    }

    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
};

const osg::Vec4 kWhite(0.95f, 0.95f, 0.92f, 1.0f), kAsphalt(0.2f, 0.2f, 0.22f, 1.0f),
    kPavement(0.6f, 0.58f, 0.55f, 1.0f), kDark(0.05f, 0.05f, 0.06f, 1.0f);
constexpr int kStreets = 4;
constexpr double kBlock = 100.0, kTown = (kStreets - 1) * kBlock, kHalfStreet = 7.0;

/// Adds rectangles of a street along x, or the same along y.
struct Street
{
    Quads& quads;
    double place;
    bool alongX;

    void add(double from, double to, double left, double right, double z, osg::Vec4 color)
    {
        if (alongX)
            quads.addGround(from, place + left, to, place + right, z, color);
        else
            quads.addGround(place + left, from, place + right, to, z, color);
    }
};

void addStreet(Quads& quads, double place, bool alongX)
{
    Street street{quads, place, alongX};
    street.add(-50, kTown + 50, -kHalfStreet, kHalfStreet, alongX ? 0.02 : 0.0, kAsphalt);
    for (int block = 0; block + 1 < kStreets; ++block)
    {
        const double from = block * kBlock + kHalfStreet, to = (block + 1) * kBlock - kHalfStreet;
        for (const double side : {-1.0, 1.0})
        {
            street.add(from, to, side * 6.8 - 0.1, side * 6.8 + 0.1, 0.04, kWhite);
            street.add(from, to, std::min(side * 7.0, side * 9.5), std::max(side * 7.0, side * 9.5),
                       0.15, kPavement);
            for (double at = from + 8.0; at < to - 8.0; at += 6.0)
                street.add(at, at + 3.0, side * 3.4 - 0.08, side * 3.4 + 0.08, 0.04, kWhite);
        }
        street.add(from + 8.0, to - 8.0, -0.1, 0.1, 0.04, osg::Vec4(0.9f, 0.75f, 0.1f, 1.0f));
        for (double across = -6.0; across < 6.0; across += 1.0) // crossings
            for (const double at : {from + 1.0, to - 4.0})
                street.add(at, at + 3.0, across, across + 0.5, 0.04, kWhite);
    }
}

void addHouses(Quads& quads, double x, double y)
{
    for (int k = 0; k < 4; ++k)
    {
        const double left = x + 15 + 40 * (k % 2), bottom = y + 15 + 40 * (k / 2);
        const double height = 8 + 20 * latticeNoise(int(left), int(bottom));
        const auto tone = static_cast<float>(0.5 + 0.4 * latticeNoise(int(left), k));
        quads.addBox(osg::Vec3(left, bottom, 0), osg::Vec3(left + 30, bottom + 30, height),
                     osg::Vec4(tone, 0.9f * tone, 0.7f * tone, 1.0f));
        for (double z = 2.0; z + 2.0 < height; z += 4.0)
            for (double at = 2.0; at < 28.0; at += 4.0)
            {
                quads.add(osg::Vec3(left + at, bottom - 0.05, z), osg::Vec3(2, 0, 0),
                          osg::Vec3(0, 0, 2), kDark);
                quads.add(osg::Vec3(left - 0.05, bottom + at + 2, z), osg::Vec3(0, -2, 0),
                          osg::Vec3(0, 0, 2), kDark);
            }
    }
}

/// Returns a car that drives along x.
osg::ref_ptr<osg::Geometry> newCar(int number)
{
    Quads quads;
    const osg::Vec4 paint(0.2f + 0.7f * float(latticeNoise(number, 1)),
                          0.2f + 0.7f * float(latticeNoise(number, 2)),
                          0.2f + 0.7f * float(latticeNoise(number, 3)), 1.0f);
    quads.addBox(osg::Vec3(-2.2f, -0.9f, 0.3f), osg::Vec3(2.2f, 0.9f, 0.9f), paint);
    quads.addBox(osg::Vec3(-1.5f, -0.8f, 0.9f), osg::Vec3(0.9f, 0.8f, 1.45f), kDark);
    quads.addBox(osg::Vec3(-1.3f, -0.75f, 1.45f), osg::Vec3(0.6f, 0.75f, 1.5f), paint);
    for (const float x : {-1.4f, 1.4f})
        for (const float y : {-0.92f, 0.72f})
            quads.addBox(osg::Vec3(x - 0.33f, y, 0.0f), osg::Vec3(x + 0.33f, y + 0.2f, 0.6f),
                         kDark);
    for (const float y : {-0.8f, 0.4f})
    {
        quads.addBox(osg::Vec3(2.2f, y, 0.55f), osg::Vec3(2.25f, y + 0.4f, 0.8f), kWhite);
        quads.addBox(osg::Vec3(-2.25f, y, 0.55f), osg::Vec3(-2.2f, y + 0.4f, 0.8f),
                     osg::Vec4(0.8f, 0.05f, 0.05f, 1.0f));
    }
    return quads.geometry();
}

} // namespace

osg::ref_ptr<osg::Group> texturedTerrain()
{
    constexpr unsigned int kQuads = 300;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> uvs = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int j = 0; j <= kQuads; ++j)
        for (unsigned int i = 0; i <= kQuads; ++i)
        {
            const double u = double(i) / kQuads, v = double(j) / kQuads;
            const double x = kTerrainSide * u, y = kTerrainSide * v;
            vertices->push_back(osg::Vec3(x, y, terrainHeight(x, y)));
            osg::Vec3 normal(terrainHeight(x - 1, y) - terrainHeight(x + 1, y),
                             terrainHeight(x, y - 1) - terrainHeight(x, y + 1), 2.0);
            normal.normalize();
            normals->push_back(normal);
            uvs->push_back(osg::Vec2(u, v));
        }
    for (unsigned int j = 0; j < kQuads; ++j)
        for (unsigned int i = 0; i < kQuads; ++i)
        {
            const unsigned int a = j * (kQuads + 1) + i, c = a + kQuads + 1;
            for (const unsigned int index : {a, a + 1, c + 1, a, c + 1, c})
                triangles->push_back(index);
        }
    osg::ref_ptr<osg::Geometry> field = new osg::Geometry;
    field->setVertexArray(vertices);
    field->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    field->setTexCoordArray(0, uvs);
    field->addPrimitiveSet(triangles);
    field->getOrCreateStateSet()->setTextureAttributeAndModes(0,
                                                              new osg::Texture2D(terrainImage()));
    osg::ref_ptr<osg::Group> root = groupInSun();
    root->addChild(field);
    return root;
}

Traffic::Traffic()
{
    root = groupInSun();
    Quads ground;
    ground.addGround(-300, -300, kTown + 300, kTown + 300, -0.05, osg::Vec4(0.35f, 0.5f, 0.3f, 1));
    for (int i = 0; i < kStreets; ++i)
        for (const bool alongX : {true, false})
            addStreet(ground, i * kBlock, alongX);
    root->addChild(ground.geometry());
    for (int y = 0; y + 1 < kStreets; ++y)
        for (int x = 0; x + 1 < kStreets; ++x)
        {
            Quads houses;
            addHouses(houses, x * kBlock, y * kBlock);
            root->addChild(houses.geometry());
        }
    constexpr int kCars = 100;
    for (int i = 0; i < kCars; ++i)
    {
        cars.push_back(new osg::MatrixTransform);
        cars.back()->setDataVariance(osg::Object::DYNAMIC);
        cars.back()->addChild(newCar(i));
        root->addChild(cars.back());
    }
    move(0.0);
}

void Traffic::move(double time)
{
    for (std::size_t i = 0; i < cars.size(); ++i)
    {
        const int number = int(i), lane = number % (4 * kStreets);
        const double street = (lane / 4) * kBlock;
        const bool alongX = lane % 2 == 0, forth = lane % 4 < 2;
        const double way =
            std::fmod(60.0 * double(i / (4 * kStreets)) + 17.0 * lane + 12.0 * time, kTown + 80.0);
        const double at = forth ? way - 40.0 : kTown + 40.0 - way;
        const double aside = forth == alongX ? -1.7 : 1.7;
        const double angle = (alongX ? 0.0 : 0.5 * osg::PI) + (forth ? 0.0 : osg::PI);
        cars[i]->setMatrix(osg::Matrixd::rotate(angle, osg::Vec3d(0, 0, 1)) *
                           osg::Matrixd::translate(alongX ? at : street + aside,
                                                   alongX ? street + aside : at, 0.03));
    }
}

} // namespace osgRayTrace::bench
