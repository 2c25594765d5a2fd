#pragma once

#include "drawing/figure.h"

#include <algorithm>
#include <string>
#include <vector>

namespace spawnfield {

/// Draws texts into an area so that they cover neither each other nor the marks there.
class TextRoom {
public:
    /// `cap` is the height of capital letters, pixels.
    TextRoom(const cv::Rect& area, double cap) : area_(area), cap_(cap) {}

    void add_mark(const cv::Rect2d& box) { taken_.push_back(box); }

    /// Draws the text if there is room for it. `corner` is its lower left corner. Returns whether there was room.
    bool draw(Figure& figure, const std::string& text, cv::Point2d corner)
    {
        const double room = 0.3 * cap_, width = text_width(text, cap_);
        const cv::Rect2d box(corner.x - room, corner.y - cap_ - room, width + 2 * room, cap_ + 2 * room);
        const auto is_covered = [&](const cv::Rect2d& other) { return (box & other).area() > 0; };
        if ((box & area_).area() < box.area() || std::any_of(taken_.begin(), taken_.end(), is_covered)) return false;
        draw_text(figure, text, corner, {cap_, ink, Align::Left, white});
        taken_.push_back(box);
        return true;
    }

private:
    const cv::Rect2d area_;
    const double cap_;
    std::vector<cv::Rect2d> taken_;
};

}  // namespace spawnfield
