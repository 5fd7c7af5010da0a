// ProjectionsTest.cpp - edges and depths of any projection are those that OpenGL draws. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/Depth>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 96;

/// A framebuffer to draw into, and how close depths must be in it.
struct Target
{
    const char* name;
    GLint depthFormat; ///< of a framebuffer object; 0: the window's own buffer
    double unit;       ///< smallest difference of two depths
    double most;       ///< largest difference of traced and drawn depths [units]
    bool lessFloats;   ///< rounding of vertices and matrices to float is allowed on top
};
const Target kTargets[] = {{"24 bits", 0, 1.0 / 16777215.0, 3.0, true},
                           {"16 bits", GL_DEPTH_COMPONENT16, 1.0 / 65535.0, 1.0, false}};

/// Red, green and blue: the mean of the samples tells how much of each colour is in a pixel.
const osg::Vec4 kColors[] = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};

struct Projection
{
    osg::Matrixd matrix;
    double nearest = 1.0, farthest = 20.0; ///< of the triangles, along -z of the eye
    bool reversed = false;
    std::string name;
};

/// Returns a perspective projection for row vectors whose far plane is at infinity: z is -1 at
/// zNear and 1 at infinity.
osg::Matrixd infinite(double left, double right, double bottom, double top, double zNear)
{
    osg::Matrixd m = osg::Matrixd::frustum(left, right, bottom, top, zNear, 2.0 * zNear);
    m(2, 2) = -1.0;
    m(3, 2) = -2.0 * zNear;
    return m;
}

/// Returns a projection of one of all kinds by its number: off-axis, sheared, tiled, orthographic
/// and oblique, with finite or infinite far planes and ordinary or reversed depths.
Projection randomProjection(int index)
{
    std::mt19937 random(1000u + static_cast<unsigned int>(index));
    const auto uniform = [&](double from, double to)
    { return from + (to - from) * (random() / 4294967296.0); };
    const double zNear = 0.5, zFar = 40.0;
    const double width = uniform(0.3, 0.8), height = uniform(0.3, 0.8);
    // The view goes as far to the side as that of a wall beside its eye.
    const double left = uniform(-1.0, 0.6), bottom = uniform(-1.0, 0.6);

    Projection p;
    const bool orthographic = index % 4 == 3;
    const bool infinitelyFar = index % 4 == 1;
    p.reversed = index % 3 == 2;
    p.name = orthographic ? "orthographic" : infinitelyFar ? "infinite" : "off-axis";
    if (orthographic)
        p.matrix = osg::Matrixd::ortho(10 * left, 10 * (left + width), 10 * bottom,
                                       10 * (bottom + height), zNear, zFar);
    else if (infinitelyFar)
        p.matrix = infinite(left, left + width, bottom, bottom + height, zNear);
    else
        p.matrix = osg::Matrixd::frustum(left, left + width, bottom, bottom + height, zNear, zFar);
    if (index % 5 == 1)
    {
        // x and y change with z, as for an oblique or turned screen.
        osg::Matrixd shear;
        shear(2, 0) = uniform(-0.4, 0.4);
        shear(2, 1) = uniform(-0.4, 0.4);
        p.matrix.preMult(shear);
        p.name += ", sheared";
    }
    if (index % 5 == 2)
    {
        // The projection is that of one of 3 x 2 tiles of the picture.
        p.matrix.postMult(
            osg::Matrixd::translate(int(random() % 3) * 2 - 2, int(random() % 2) * 2 - 1, 0) *
            osg::Matrixd::scale(3, 2, 1));
        p.name += ", tile";
    }
    if (p.reversed)
    {
        p.matrix.postMult(osg::Matrixd::scale(1, 1, -1));
        p.name += ", reversed";
    }
    if (index % 7 == 6)
    {
        for (int i = 0; i < 16; ++i)
            p.matrix.ptr()[i] *= 7.5; // clip coordinates are homogeneous
        p.name += ", scaled";
    }
    return p;
}

/// Returns the point at x and y of the picture, from -1 to 1, at a distance along -z.
osg::Vec3d seenAt(const osg::Matrixd& projection, double x, double y, double distance)
{
    // The two other coordinates follow from two equations of the clip coordinates: x w = X and y w
    // = Y.
    const auto at = [&](int column, double factor, int row)
    { return projection(row, column) - factor * projection(row, 3); };
    const double z = -distance;
    const double a = at(0, x, 0), b = at(0, x, 1), c = at(1, y, 0), d = at(1, y, 1);
    const double e = -(at(0, x, 2) * z + at(0, x, 3)), f = -(at(1, y, 2) * z + at(1, y, 3));
    const double determinant = a * d - b * c;
    return {(e * d - b * f) / determinant, (a * f - e * c) / determinant, z};
}

/// Returns triangles each of which fills a part of the picture: either they are tilted so that they
/// intersect, or each has a constant distance.
osg::ref_ptr<osg::Geometry> triangles(const Projection& p, const osg::Matrixd& worldFromView,
                                      int index, bool tilted)
{
    std::mt19937 random(2000u + static_cast<unsigned int>(index));
    const auto uniform = [&](double from, double to)
    { return from + (to - from) * (random() / 4294967296.0); };
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (const osg::Vec4& color : kColors)
    {
        const double x = uniform(-0.4, 0.4), y = uniform(-0.4, 0.4), turn = uniform(0.0, 6.0);
        double distance = 0.0;
        for (int corner = 0; corner < 3; ++corner)
        {
            const double angle = turn + corner * 2.0 * osg::PI / 3.0;
            if (tilted || corner == 0) distance = uniform(p.nearest, p.farthest);
            vertices->push_back(
                seenAt(p.matrix, x + 0.7 * std::cos(angle), y + 0.7 * std::sin(angle), distance) *
                worldFromView);
            colors->push_back(color);
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 9));
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    geometry->setUseDisplayList(false);
    return geometry;
}

/// Returns the same triangles, each of which begins with another corner.
osg::ref_ptr<osg::Geometry> turned(const osg::Geometry& geometry)
{
    osg::ref_ptr<osg::Geometry> result = new osg::Geometry(geometry);
    osg::ref_ptr<osg::Vec3Array> vertices =
        new osg::Vec3Array(static_cast<const osg::Vec3Array&>(*geometry.getVertexArray()));
    for (std::size_t i = 0; i < vertices->size(); i += 3)
        std::rotate(&(*vertices)[i], &(*vertices)[i] + 1, &(*vertices)[i] + 3);
    result->setVertexArray(vertices);
    return result;
}

struct Shot
{
    osg::ref_ptr<osg::Image> color, depth;
};

osg::ref_ptr<osg::Image> attach(osg::Camera& camera, osg::Camera::BufferComponent buffer,
                                GLint internalFormat, GLenum format, GLenum type)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(kSize, kSize, 1, format, type);
    image->setInternalTextureFormat(internalFormat);
    camera.attach(buffer, image.get());
    return image;
}

Shot shot(osg::Node* node, const Projection& p, const osg::Matrixd& viewFromWorld,
          const Target& target)
{
    TestViewer view(kSize, kSize, node);
    view.camera().setProjectionResizePolicy(osg::Camera::FIXED);
    view.camera().setProjectionMatrix(p.matrix);
    view.camera().setViewMatrix(viewFromWorld);
    if (p.reversed)
    {
        view.camera().setClearDepth(0.0);
        view.camera().getOrCreateStateSet()->setAttributeAndModes(
            new osg::Depth(osg::Depth::GREATER), osg::StateAttribute::ON);
    }
    Shot made;
    if (target.depthFormat != 0)
    {
        osg::Camera& camera = view.camera();
        camera.setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
        made.color = attach(camera, osg::Camera::COLOR_BUFFER, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
        made.depth = attach(camera, osg::Camera::DEPTH_BUFFER, target.depthFormat,
                            GL_DEPTH_COMPONENT, GL_FLOAT);
        view.frames();
        return made;
    }
    made.color = view.frames();
    made.depth = new osg::Image(*view.capture->getDepthImage(), osg::CopyOp::DEEP_COPY_ALL);
    return made;
}

/// Returns the one colour that the whole pixel has, 3 for the background, or -1 if the pixel has
/// several colours.
int pure(const osg::Image& image, int x, int y)
{
    const osg::Vec4 color = pixel(image, x, y);
    for (int c = 0; c < 3; ++c)
        if (color[c] == 255.0f) return c;
    return color.r() + color.g() + color.b() == 0.0f ? 3 : -1;
}

/// Returns a whole number of the buffer's units, because the depth is read back as a float.
double depthAt(const Shot& shot, int x, int y, const Target& target)
{
    const float depth = *reinterpret_cast<const float*>(shot.depth->data(x, y));
    return std::round(depth / target.unit) * target.unit;
}

/// Holds the window depth, in double, of a triangle in the middle of a pixel.
struct ExactDepth
{
    double depth;
    double tolerance; ///< effect of rounding vertices and matrices to float, in OpenGL and in rays
};

ExactDepth exactDepth(const osg::Geometry& geometry, int triangle,
                      const osg::Matrixd& viewFromWorld, const osg::Matrixd& projection, int x,
                      int y)
{
    // The depth is linear in window coordinates for any projection, so it lies in the plane through
    // the corners' window coordinates.
    const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
    osg::Vec3d corners[3];
    for (int i = 0; i < 3; ++i)
        corners[i] = osg::Vec3d(vertices[static_cast<std::size_t>(3 * triangle + i)]) *
                     (viewFromWorld * projection);
    const osg::Vec3d normal = (corners[1] - corners[0]) ^ (corners[2] - corners[0]);
    const osg::Vec3d at((2.0 * x + 1.0) / kSize - 1.0, (2.0 * y + 1.0) / kSize - 1.0, 0.0);
    const osg::Vec3d offset = corners[0] - at;
    const double clip = (normal * offset) / normal.z();
    const double slope =
        (std::fabs(normal.x()) + std::fabs(normal.y())) / std::fabs(normal.z()) / kSize;

    // The tolerance is a ten-thousandth of a pixel along the slope, and the depth of two spacings
    // of floats at the point's coordinates: one for rounding the vertices, one for rounding the
    // point between them.
    const double a = projection(2, 2), b = projection(3, 2), c = projection(2, 3),
                 d = projection(3, 3);
    const double z = (b - clip * d) / (clip * c - a);
    const osg::Vec3d point =
        seenAt(projection, at.x(), at.y(), -z) * osg::Matrixd::inverse(viewFromWorld);
    const double moved = z + point.length() * 0x1p-22;
    const double spacing = 0.5 * std::fabs((a * moved + b) / (c * moved + d) - clip);
    return {0.5 + 0.5 * clip, 1e-4 * slope + spacing};
}

struct Agreement
{
    int wrong = 0;      ///< pixels whose edge is displaced by half a pixel or more
    int edges = 0;      ///< pixels with an edge
    int inner = 0;      ///< pixels whose depth can be compared
    double shift = 0.0; ///< mean signed displacement of edges [pixels]
    double nearestInner = 0.0, nearestEdge = 0.0; ///< largest 1 - depth, or depth if reversed
    // These are the largest differences of depth [units].
    double units = 0.0;
    double lessFloats = 0.0;                    ///< reduced by the effect of floats
    double tracedError = 0.0, drawnError = 0.0; ///< from the exact depth, reduced likewise
    double drawnTwice = 0.0;                    ///< between two drawings of the same triangles
};

/// Compares a traced picture with a drawn one. A pixel in whose middle OpenGL draws a colour must
/// show some of this colour. A pixel that has a single colour in the traced picture must have it in
/// its middle in the drawn one. Otherwise an edge is half a pixel away.
Agreement agreement(const Shot& traced, const Shot& drawn, const Shot& drawnAgain,
                    const osg::Geometry& geometry, const osg::Matrixd& viewFromWorld,
                    const Projection& p, const Target& target)
{
    Agreement result;
    double shift = 0.0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            const int expected = pure(*drawn.color, x, y);
            const osg::Vec4 seen = pixel(*traced.color, x, y);
            const int all = pure(*traced.color, x, y);
            const float covered = seen.r() + seen.g() + seen.b();
            const bool some = expected == 3 ? covered < 254.0f : seen[expected] > 0.0f;
            result.wrong += !some || (all >= 0 && all != expected);
            result.edges += all < 0;
            const double nearness =
                p.reversed ? depthAt(traced, x, y, target) : 1.0 - depthAt(traced, x, y, target);
            double& nearest = all < 0 ? result.nearestEdge : result.nearestInner;
            nearest = std::max(nearest, nearness);
            shift += (covered - (expected == 3 ? 0.0 : 255.0)) / 255.0;
            if (all < 0 || all == 3 || all != expected) continue;
            ++result.inner;
            const ExactDepth exact = exactDepth(geometry, all, viewFromWorld, p.matrix, x, y);
            const double t = depthAt(traced, x, y, target), d = depthAt(drawn, x, y, target);
            const auto note = [&](double& largest, double difference, double tolerance)
            { largest = std::max(largest, (std::fabs(difference) - tolerance) / target.unit); };
            note(result.units, t - d, 0.0);
            note(result.lessFloats, t - d, exact.tolerance);
            note(result.tracedError, t - exact.depth, exact.tolerance);
            note(result.drawnError, d - exact.depth, exact.tolerance);
            if (expected == pure(*drawnAgain.color, x, y))
                note(result.drawnTwice, depthAt(drawnAgain, x, y, target) - d, 0.0);
        }
    result.shift = shift / std::max(1, result.edges);
    return result;
}

} // namespace

TEST_CASE("projections: edges and depths of twenty kinds are those of the rasterizer", "[gl]")
{
    const osg::Matrixd viewFromWorld = osg::Matrixd::lookAt(
        osg::Vec3d(0.375, -0.625, 0.25), osg::Vec3d(1.5, 2.0, 0.5), osg::Vec3d(0, 0, 1));
    const osg::Matrixd worldFromView = osg::Matrixd::inverse(viewFromWorld);
    const bool tilted = GENERATE(true, false);
    const int bits = GENERATE(0, 1);
    const Target& target = kTargets[bits];
    const int part = 2 * bits + tilted;
    Agreement worst;
    for (int index = 0; index < 20; ++index)
    {
        if (kSanitized && index / 4 % 4 != part) continue; // each projection is tested once
        const Projection p = randomProjection(index);
        CAPTURE(index, p.name, tilted, target.name);
        const osg::ref_ptr<osg::Geometry> geometry = triangles(p, worldFromView, index, tilted);
        const Shot drawn = shot(geometry.get(), p, viewFromWorld, target);
        // The difference of two drawings by OSMesa tells how accurate its 24 bits are.
        const Shot drawnAgain = tilted && target.lessFloats
                                    ? shot(turned(*geometry).get(), p, viewFromWorld, target)
                                    : drawn;
        const osg::ref_ptr<RayTracedScene> scene = tracedScene(geometry.get());
        scene->getSettings()->setPassesPerFrame(64);
        const Shot traced = shot(scene.get(), p, viewFromWorld, target);
        REQUIRE(scene->getDrawable()->getStatistics().passes == 64);
        if (const char* folder = std::getenv("OSGRAYTRACE_PICTURES"))
        {
            const std::string name = std::string(folder) + "/projection-" + std::to_string(index) +
                                     (tilted ? "-tilted-" : "-facing-") + target.name[0];
            osgDB::writeImageFile(*drawn.color, name + "-osg.png");
            osgDB::writeImageFile(*traced.color, name + "-traced.png");
        }
        const Agreement same =
            agreement(traced, drawn, drawnAgain, *geometry, viewFromWorld, p, target);
        CHECK(same.wrong == 0);
        CHECK(std::fabs(same.shift) < 0.05);
        CHECK(same.tracedError <= 1.0);
        CHECK((target.lessFloats ? same.lessFloats : same.units) <= target.most + 1e-6);
        // Pixels whose first sample missed have no depth: their depth is right in front of the
        // background.
        if (!tilted) CHECK(same.nearestEdge <= same.nearestInner + 2.0 * target.unit);
        CHECK(same.edges > 50);
        CHECK(same.inner > 800);
        worst.shift = std::max(worst.shift, std::fabs(same.shift));
        worst.units = std::max(worst.units, same.units);
        worst.lessFloats = std::max(worst.lessFloats, same.lessFloats);
        worst.tracedError = std::max(worst.tracedError, same.tracedError);
        worst.drawnError = std::max(worst.drawnError, same.drawnError);
        worst.drawnTwice = std::max(worst.drawnTwice, same.drawnTwice);
    }
    std::cout << "twenty projections, " << (tilted ? "tilted, " : "facing, ") << target.name
              << ": edges shifted by up to " << worst.shift << " pixels; depths differ by "
              << worst.units << " units, by " << worst.lessFloats
              << " more than floats are worth; from the truth traced " << worst.tracedError
              << ", drawn " << worst.drawnError << "; drawn twice " << worst.drawnTwice
              << std::endl;
}
