#pragma once

#include <string>
#include <vector>

/// Texts of an SVG file in their order; those that are there twice, for their halo, once.
std::vector<std::string> svg_texts(const std::string& svg);

/// Content of the first page of a PDF that libharu wrote: its operators as text.
std::string pdf_page(const std::string& pdf);
