// pictureCheck.cpp - tells by its exit code whether the examples' pictures are right.
// SPDX-License-Identifier: MIT
#include <osg/Image>
#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

osg::ref_ptr<osg::Image> read(const std::string& file)
{
    osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(file);
    if (!image) throw std::runtime_error(file + " cannot be read");
    return image;
}

void expect(bool condition, const std::string& what)
{
    if (!condition) throw std::runtime_error(what);
}

/// Implements "model FILE": writes a ball before a wall in slanting sunlight.
void writeModel(const std::string& file)
{
    osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    sun->getLight()->setPosition(osg::Vec4(2.0f, -2.0f, 1.0f, 0.0f));
    sun->addChild(new osg::ShapeDrawable(new osg::Sphere));
    sun->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(0.0f, 2.0f, 0.0f), 8, 1, 6)));
    expect(osgDB::writeNodeFile(*sun, file), file + " cannot be written");
}

/// Implements "lit FILE": the picture must be neither black nor white, and not of one colour. The
/// mean of RGB goes from 0 to 1.
void checkLit(const std::string& file)
{
    const osg::ref_ptr<osg::Image> image = read(file);
    double sum = 0.0, squares = 0.0;
    for (int y = 0; y < image->t(); ++y)
        for (int x = 0; x < image->s(); ++x)
        {
            const osg::Vec4 color = image->getColor(unsigned(x), unsigned(y));
            const double value = (color.r() + color.g() + color.b()) / 3.0;
            sum += value;
            squares += value * value;
        }
    const double count = double(image->s()) * image->t();
    const double mean = sum / count;
    const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
    std::cout << file << ": mean " << mean << ", standard deviation " << deviation << '\n';
    expect(mean > 0.05 && mean < 0.95 && deviation > 0.05, file + " is blank");
}

/// Returns the mean of factor by factor pixels.
osg::Vec4 meanColor(const osg::Image& image, int x, int y, int factor)
{
    osg::Vec4 sum;
    for (int i = 0; i < factor * factor; ++i)
        sum += image.getColor(unsigned(x * factor + i % factor), unsigned(y * factor + i / factor));
    return sum / float(factor * factor);
}

/// Implements "differ A B LEAST MOST": checks the mean absolute difference of RGB in the middle
/// half of each side, in units of 1/255. A may be larger by a whole factor.
void checkDifference(const std::string& a, const std::string& b, double least, double most)
{
    const osg::ref_ptr<osg::Image> first = read(a), second = read(b);
    const int width = second->s(), height = second->t(), factor = first->s() / width;
    expect(factor > 0 && first->s() == factor * width && first->t() == factor * height,
           a + " and " + b + " do not match in size");
    double sum = 0.0;
    int count = 0;
    for (int y = height / 4; y < height * 3 / 4; ++y)
        for (int x = width / 4; x < width * 3 / 4; ++x, count += 3)
        {
            const osg::Vec4 difference =
                meanColor(*first, x, y, factor) - second->getColor(unsigned(x), unsigned(y));
            for (int c = 0; c < 3; ++c)
                sum += std::abs(difference[c]);
        }
    const double mean = 255.0 * sum / count;
    std::cout << a << " and " << b << ": mean difference " << mean << "/255\n";
    expect(mean >= least && mean <= most, a + " and " + b + " differ by so much");
}

/// Returns the mean column, from the left of the half, of the pixels in which one colour is
/// brighter than the others.
double meanColumn(const osg::Image& image, int half, unsigned channel)
{
    const int width = image.s() / 2;
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < width; ++x)
        {
            const osg::Vec4 color = image.getColor(unsigned(half * width + x), unsigned(y));
            const float others = color[(channel + 1) % 3] + color[(channel + 2) % 3];
            if (color[channel] < 0.1f || color[channel] < 1.5f * others) continue;
            sum += x;
            ++count;
        }
    expect(count > 100, "a half of the picture does not show each ball");
    return sum / count;
}

/// Implements "parallax FILE LEAST": the left eye's picture must be on the left. Compared with the
/// right eye's picture, it must have objects before the screen (red) further to the right and
/// objects behind it (blue) further to the left, each by LEAST pixels at least. Objects on the
/// screen (green) must be in the same place.
void checkParallax(const std::string& file, double least)
{
    const osg::ref_ptr<osg::Image> image = read(file);
    double shift[3] = {};
    for (unsigned c = 0; c < 3; ++c)
        shift[c] = meanColumn(*image, 0, c) - meanColumn(*image, 1, c);
    std::cout << file << ": left against right, red " << shift[0] << ", green " << shift[1]
              << ", blue " << shift[2] << " pixels\n";
    expect(shift[0] > least, "what is before the screen is not there");
    expect(std::abs(shift[1]) < 2.0, "what is on the screen is not there");
    expect(shift[2] < -least, "what is behind the screen is not there");
}

/// Implements "materials FILE": chrome, gold, plastic and glass must stand from the left to the
/// right, each in its colour.
void checkMaterials(const std::string& file)
{
    const osg::ref_ptr<osg::Image> image = read(file);
    osg::Vec4 balls[4];
    for (int i = 0; i < 4; ++i)
    {
        // A square of 8 x 8 pixels is in the middle of the ball.
        const int x = int(image->s() * (0.5 + 0.171 * (i - 1.5))), y = image->t() / 2;
        balls[i] = meanColor(*image, x / 8, y / 8, 8);
        std::cout << file << ": ball " << i << " has the colour " << balls[i].r() << ' '
                  << balls[i].g() << ' ' << balls[i].b() << '\n';
    }
    const auto& [chrome, gold, plastic, glass] = balls;
    expect(gold.r() * chrome.b() > 1.3f * chrome.r() * gold.b(), "the gold is not yellow");
    expect(plastic.r() > 2.0f * plastic.g() && plastic.r() > 2.0f * plastic.b(),
           "the plastic is not red");
    for (const osg::Vec4& color : {chrome, glass})
        expect(color.r() + color.g() + color.b() > 0.6f && color.b() > 0.8f * color.r(),
               "chrome or glass does not show the sky");
}

void check(const std::vector<std::string>& words)
{
    const std::string command = words.empty() ? "" : words[0];
    if (command == "model" && words.size() == 2) return writeModel(words[1]);
    if (command == "lit" && words.size() == 2) return checkLit(words[1]);
    if (command == "differ" && words.size() == 5)
        return checkDifference(words[1], words[2], std::stod(words[3]), std::stod(words[4]));
    if (command == "parallax" && words.size() == 3)
        return checkParallax(words[1], std::stod(words[2]));
    if (command == "materials" && words.size() == 2) return checkMaterials(words[1]);
    throw std::runtime_error("no such check: " + command);
}

} // namespace

int main(int argc, char** argv)
try
{
    check({argv + 1, argv + argc});
    return 0;
}
catch (const std::exception& error)
{
    std::cerr << "pictureCheck: " << error.what() << '\n';
    return 1;
}
