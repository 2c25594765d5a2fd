#pragma once

#include <string>
#include <vector>

/// Returns the texts of an SVG file in their order. A text that is drawn twice, first as its halo, is returned once.
std::vector<std::string> svg_texts(const std::string& svg);

/// Returns the content of the first page of a PDF that libharu wrote: its operators as text.
std::string pdf_page(const std::string& pdf);
