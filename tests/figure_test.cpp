#include "catch.h"
#include "figure_text.h"
#include "drawing/figure.h"
#include "program.h"

#include <spawnfield/error.h>

#include <opencv2/imgcodecs.hpp>
#include <tinyxml2.h>

using namespace spawnfield;

namespace {

/// Returns a figure of 60 x 40 pixels with a mark of each kind.
Figure each_mark()
{
    Figure figure{{60, 40}, {}};
    Image ground(10, 20, rgb(0x336699));
    ground(9, 0) = rgb(0xff0000);
    draw_image(figure, {5, 5}, ground);
    clip(figure, {5, 5, 20, 10});
    draw_polygon(figure, {{20, 0}, {40, 0}, {40, 30}, {20, 30}}, rgb(0x00ff00), ink, 0);
    clip(figure, {});
    fill(figure, {40, 20, 4, 5}, rgb(0x0000ff));
    draw_dot(figure, {50, 10}, 3, rgb(0x123456), ink, 0);
    draw_text(figure, "a < b & c", {2, 38}, {8});
    draw_text(figure, "right", {58, 38}, {6, muted, Align::Right, white});
    return figure;
}

std::vector<const tinyxml2::XMLElement*> elements_of(const tinyxml2::XMLNode& node, const std::string& name)
{
    std::vector<const tinyxml2::XMLElement*> out;
    for (const tinyxml2::XMLElement* child = node.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
        if (child->Name() == name) out.push_back(child);
        for (const tinyxml2::XMLElement* below : elements_of(*child, name)) out.push_back(below);
    }
    return out;
}

std::vector<std::uint8_t> from_base64(const std::string& text)
{
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> out;
    unsigned bits = 0, count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | unsigned(digits.find(c));
        count += 6;
        if (count >= 8) out.push_back(std::uint8_t(bits >> (count -= 8)));
    }
    return out;
}

}  // namespace

TEST_CASE("marks are painted in their order, and cut at the clip rectangle")
{
    const Image image = paint(each_mark());
    CHECK(image.size() == cv::Size(60, 40));
    CHECK(image(0, 0) == white);
    CHECK(image(5, 5) == rgb(0x336699));
    CHECK(image(14, 5) == rgb(0xff0000));
    CHECK(image(10, 22) == rgb(0x00ff00));  // inside the clip rectangle
    CHECK(image(10, 30) == white);          // outside it
    CHECK(image(2, 22) == white);
    CHECK(image(22, 42) == rgb(0x0000ff));
    CHECK(image(10, 50) == rgb(0x123456));
}

TEST_CASE("an SVG has each mark as an element, texts as text, and the complete image")
{
    tinyxml2::XMLDocument document;
    const std::string text = svg_of(each_mark());
    REQUIRE(document.Parse(text.c_str()) == tinyxml2::XML_SUCCESS);
    CHECK(document.RootElement()->IntAttribute("width") == 60);
    CHECK(std::string(document.RootElement()->Attribute("viewBox")) == "0 0 60 40");
    CHECK(svg_texts(text) == std::vector<std::string>{"a < b & c", "right"});
    const auto clipped = elements_of(document, "g");
    REQUIRE(clipped.size() == 1);
    CHECK(std::string(clipped[0]->Attribute("clip-path")) == "url(#clip1)");
    CHECK(std::string(clipped[0]->FirstChildElement("polygon")->Attribute("points")) == "20,0 40,0 40,30 20,30");
    CHECK(elements_of(document, "circle").size() == 1);

    const auto images = elements_of(document, "image");
    REQUIRE(images.size() == 1);
    const std::string data = images[0]->Attribute("xlink:href"), head = "data:image/png;base64,";
    REQUIRE(data.starts_with(head));
    const Image pixels = cv::imdecode(from_base64(data.substr(head.size())), cv::IMREAD_COLOR);
    REQUIRE(pixels.size() == cv::Size(20, 10));
    CHECK(pixels(9, 0) == rgb(0xff0000));
    CHECK(pixels(0, 19) == rgb(0x336699));
}

TEST_CASE("a PDF is one page with texts and paths, and has no date")
{
    const std::string pdf = pdf_of(each_mark()), page = pdf_page(pdf);
    CHECK(pdf.starts_with("%PDF-"));
    CHECK(pdf.find("Date") == std::string::npos);
    CHECK_THAT(pdf, Contains("/MediaBox [ 0 0 43.2 28.8 ]"));
    CHECK_THAT(page, Contains("(a \\074 b & c) Tj"));
    CHECK_THAT(page, Contains("20 40 m\n40 40 l\n40 10 l\n20 10 l\nh\n"));  // y points up, from the lower edge
    CHECK_THAT(page, Contains("5 25 20 10 re\nW\nn\n"));                    // the clip rectangle
    CHECK(page.find(" rg\n") != std::string::npos);
}

TEST_CASE("figures are the same bytes each time")
{
    CHECK(svg_of(each_mark()) == svg_of(each_mark()));
    CHECK(pdf_of(each_mark()) == pdf_of(each_mark()));
}

TEST_CASE("PDFs can have thousands of marks, and pages as large as the largest pictures")
{
    Figure figure{{16000, 16000}, {}};
    for (int k = 0; k < 20000; ++k) draw_dot(figure, {k * 0.8, 8000}, 2, white, ink, 1);
    CHECK(pdf_of(figure).size() > 10000);
}

TEST_CASE("the extension of a file selects its format, and other extensions are refused")
{
    CHECK(picture_format("a.png") == PictureFormat::Png);
    CHECK(picture_format("folder.x/a.SVG") == PictureFormat::Svg);
    CHECK(picture_format("a.pdf") == PictureFormat::Pdf);
    CHECK(picture_format("folder.x/a") == PictureFormat::Png);
    CHECK(picture_format("/dev/stdout") == PictureFormat::Png);
    CHECK_THROWS_WITH(picture_format("a.jpg"),
                      Contains("a.jpg ends in .jpg, but pictures are written as .png, .svg or .pdf"));
    CHECK_THROWS_AS(picture_format("a.png.gz"), ArgumentError);
    CHECK_THROWS_AS(picture_format("a."), ArgumentError);
}
