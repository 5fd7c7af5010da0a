// ReportPageTest.cpp - the report's page as a browser shows it. Layer: tests.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/ReportPage.h"
#include "apps/osgraytracebench/report/Html.h"
#include "apps/osgraytracebench/report/Plots.h"
#include "tests/Catch.h"
#include "tests/apps/Reports.h"
#include "tests/plugins/TemporaryFolder.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

using namespace osgRayTrace::bench;

namespace
{

std::string contents(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

bool haveChromium()
{
    if (std::system("chromium --version >/dev/null 2>&1") == 0) return true;
    WARN("There is no chromium, so nobody has looked at the report's page.");
    return false;
}

/// Returns a page with plots, tables, checks and pictures. The pictures are wider than high.
std::string smallPage()
{
    Report report = smallReport();
    // Sorted as texts, these would be in another order than as numbers.
    report.lines[0].rows.back().relMse = 9e-5;
    report.lines[1].rows.back().relMse = 1e-2;
    report.lines[0].secondsTo[1].reset();
    Reference reference;
    reference.width = 32;
    reference.height = 16;
    reference.mean.assign(3 * 32 * 16, 0.5);
    reference.meanLuminance = reference.meanValue = 0.5;
    Pixels pixels;
    pixels.width = 32;
    pixels.height = 16;
    pixels.rgb.assign(3 * 32 * 16, 0.501f);
    SceneThumbnails square{"s1-square", "S1: a square", thumbnail(reference), {}};
    square.lines.push_back({"WHITTED random", "4 passes", thumbnail(pixels, reference),
                            errorThumbnail(pixels, reference)});
    SceneThumbnails mirror{"s6-flat-mirror", "S6: <a mirror>", "", {}};
    return reportPage(report, {square, mirror}, {{"a & b", true}, {"c < d", false}});
}

/// Looks at the page from within, and sends the problems, one a line, to the frame.
constexpr const char* kInspection = R"script(<script>
addEventListener('load', () => {
    const problems = [];
    const check = (good, text) => { if (!good) problems.push(text); };
    const all = (selector) => [...document.querySelectorAll(selector)];

    for (const entry of performance.getEntriesByType('resource'))
        check(entry.name.startsWith('data:'), 'fetched ' + entry.name.slice(0, 80));
    check(all('img').length === PICTURES, 'pictures: ' + all('img').length);
    check(all('img').every((i) => i.naturalWidth === 32 && i.alt !== ''), 'a picture is broken');
    check(all('img').every((i) => Math.abs(i.width / i.height - 2) < 0.1), 'a picture is squeezed');
    check(all('.plot > svg').length === PLOTS, 'plots: ' + all('.plot > svg').length);
    for (const plot of all('.plot > svg')) {
        const box = plot.getBoundingClientRect();
        check(box.width > 200 && box.height > 100, 'a plot is not shown');
        check(plot.querySelectorAll('text').length > 3, 'a plot has no axes');
        const text = plot.querySelector('text').getBoundingClientRect();
        check(text.height > 8, 'the text of a plot is ' + text.height + ' high');
        check(plot.parentElement.querySelectorAll('.legend li').length > 3, 'a legend is short');
    }
    const names = all('[id]').map((e) => e.id);
    check(new Set(names).size === names.length, 'elements share a name');
    check(all('nav a').every((a) => document.querySelector(a.hash)), 'a link leads nowhere');
    check(document.querySelector('details.checks').open, 'failed checks are hidden');

    // Only boxes of tables move sideways.
    check(innerWidth === WIDTH, 'the page is ' + innerWidth + ' wide');
    check(document.documentElement.scrollWidth <= innerWidth, 'the page scrolls sideways');

    const light = (colour) => {
        const [r, g, b] = colour.match(/\d+/g).map((v) => {
            const x = v / 255;
            return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
        });
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const paper = light(getComputedStyle(document.body).backgroundColor);
    check(DARK ? paper < 0.05 : paper > 0.9, 'the paper is ' + paper);
    const contrast = (element, property) => {
        const ink = light(getComputedStyle(element)[property]);
        return (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
    };
    for (const e of all('p, td, th button, summary, dt, dd, figcaption, a, li, h1, h2'))
        check(contrast(e, 'color') >= 4.5, e.tagName + ' is hard to read');
    for (const e of all('.plot > svg text'))
        check(contrast(e, 'fill') >= 4.5, 'the text of a plot is hard to read');

    const table = document.querySelector('table');
    const column = (c) => [...table.tBodies[0].rows].map((row) => row.cells[c].textContent);
    const click = (name) => {
        const heads = [...table.tHead.rows[0].cells];
        const c = heads.findIndex((h) => h.textContent === name);
        heads[c].querySelector('button').click();
        return [column(c), heads[c].getAttribute('aria-sort')];
    };
    const sorted = (list, less) => list.every((v, i) => i === 0 || !less(v, list[i - 1]));
    const numeric = (a, b) => parseFloat(a) < parseFloat(b);
    let [values, order] = click('relMSE');
    check(values.length === 4 && sorted(values, numeric) && order === 'ascending', 'sorted: ' + values);
    [values, order] = click('relMSE');
    check(sorted(values.reverse(), numeric) && order === 'descending', 'down: ' + values);
    [values] = click('method');
    check(sorted(values, (a, b) => a.localeCompare(b) < 0), 'by name: ' + values);
    for (let twice = 0; twice < 2; ++twice) {
        [values] = click('s to 1e-2');
        check(values[3] === '\u2013' && values[0] === '0.5', 'missing values: ' + values);
    }
    parent.postMessage(problems.join('\n') + '\nlooked at', '*');
});
</script>)script";

std::string inspection(int width, bool dark)
{
    std::string text = kInspection;
    const auto set = [&](const std::string& name, const std::string& value)
    {
        for (std::size_t at = 0; (at = text.find(name)) != std::string::npos;)
            text.replace(at, name.size(), value);
    };
    set("WIDTH", std::to_string(width));
    set("DARK", dark ? "true" : "false");
    set("PLOTS", haveGnuplot() ? "4" : "0");
    set("PICTURES", "3");
    return text;
}

/// Returns a page that shows page.html in a frame of this width, since windows cannot be as narrow
/// as a phone, and writes down what it sends.
std::string frameOf(int width)
{
    return "<!DOCTYPE html><title>frame</title><pre id=problems></pre><script>"
           "addEventListener('message', (event) => { "
           "document.getElementById('problems').textContent = event.data; });</script>"
           "<iframe src=page.html style=border:0 height=800 width=" +
           std::to_string(width) + "></iframe>";
}

/// Runs Chromium in the folder; returns what it says, its complaints about the page included.
std::string chromium(const TemporaryFolder& folder, const std::string& arguments)
{
    const std::string command =
        "cd '" + folder / "." + "' && HOME=. timeout 60 chromium --headless --no-sandbox " +
        "--disable-gpu --hide-scrollbars --no-first-run --disable-background-networking " +
        "--disable-dev-shm-usage --user-data-dir=profile --enable-logging=stderr " + arguments +
        " >out 2>errors </dev/null";
    CHECK(std::system(command.c_str()) == 0);
    return contents(folder / "errors");
}

/// Returns the problems that the page had with itself.
std::string problemsOf(const std::string& dom)
{
    const std::string start = "<pre id=\"problems\">";
    const std::size_t begin = dom.find(start), end = dom.find("</pre>", begin);
    if (begin == std::string::npos || end == std::string::npos) return "no result: " + dom;
    return dom.substr(begin + start.size(), end - begin - start.size());
}

} // namespace

TEST_CASE("report's page: nothing of it comes from elsewhere", "[apps][report]")
{
    const std::string page = smallPage();
    CHECK(page.find("Content-Security-Policy content=\"default-src 'none'") != std::string::npos);
    CHECK(page.find("src=\"http") == std::string::npos);
    CHECK(page.find("url(http") == std::string::npos);
    CHECK(page.find("S6: &lt;a mirror&gt;") != std::string::npos);
    CHECK(page.find("c &lt; d") != std::string::npos);
}

TEST_CASE("report's page: shown by a browser, wide, on a phone and in the dark", "[apps][report]")
{
    if (!haveChromium()) return;
    const std::string page = smallPage();
    struct Case
    {
        const char* name;
        int width;
        bool dark;
    };
    for (const Case& shown : {Case{"desktop", 1280, false}, Case{"phone in the dark", 390, true}})
    {
        CAPTURE(shown.name);
        const TemporaryFolder folder;
        std::ofstream(folder / "page.html") << page << inspection(shown.width, shown.dark);
        std::ofstream(folder / "frame.html") << frameOf(shown.width);
        const std::string errors =
            chromium(folder, std::string(shown.dark ? "--force-dark-mode " : "") +
                                 "--virtual-time-budget=2000 --dump-dom frame.html");
        CHECK(errors.find("CONSOLE") == std::string::npos);
        CHECK(problemsOf(contents(folder / "out")) == "\nlooked at");
    }
}

TEST_CASE("report's page: printed", "[apps][report]")
{
    if (!haveChromium()) return;
    const TemporaryFolder folder;
    std::ofstream(folder / "page.html") << smallPage();
    chromium(folder, "--no-pdf-header-footer --print-to-pdf=page.pdf page.html");
    const std::string pdf = contents(folder / "page.pdf");
    CHECK(pdf.substr(0, 5) == "%PDF-");
    CHECK(pdf.find("/MediaBox [0 0 841") != std::string::npos); // A4 on its side
}
