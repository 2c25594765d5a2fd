#include "figure_text.h"

#include <tinyxml2.h>
#include <zlib.h>

#include <stdexcept>

namespace {

void add_texts(const tinyxml2::XMLElement& element, std::vector<std::string>& out)
{
    const bool is_halo = element.Attribute("fill", "none") != nullptr;
    if (std::string(element.Name()) == "text" && !is_halo) out.emplace_back(element.GetText() ? element.GetText() : "");
    for (const tinyxml2::XMLElement* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement())
        add_texts(*child, out);
}

std::string inflated(const std::string& bytes)
{
    std::string out(1 << 22, '\0');
    uLongf size = out.size();
    const int result = uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    if (result != Z_OK) return "";
    out.resize(size);
    return out;
}

}  // namespace

std::vector<std::string> svg_texts(const std::string& svg)
{
    tinyxml2::XMLDocument document(true, tinyxml2::PRESERVE_WHITESPACE);
    if (document.Parse(svg.c_str(), svg.size()) != tinyxml2::XML_SUCCESS) throw std::runtime_error(document.ErrorStr());
    std::vector<std::string> out;
    add_texts(*document.RootElement(), out);
    return out;
}

std::string pdf_page(const std::string& pdf)
{
    for (std::size_t stream = pdf.find("stream\r\n"); stream != std::string::npos;
         stream = pdf.find("stream\r\n", stream + 1)) {
        const std::size_t start = stream + 8, end = pdf.find("endstream", start);
        const std::string content = inflated(pdf.substr(start, end - start));
        if (content.find(" cm\n") != std::string::npos) return content;
    }
    throw std::runtime_error("the PDF has no page content");
}
