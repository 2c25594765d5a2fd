#include "picture/picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace spawnfield {
namespace {

// Lengths in units: thousandths of the picture's longer side.
constexpr double text_cap = 10.5, small_cap = 9.5, title_cap = 15;  // heights of capital letters
constexpr double margin = 18, tick_length = 6, gap = 7, column_gap = 30;
constexpr double bearing_width = 160, bearing_height = 54, longest_scale_bar = 110;
constexpr double infinite = std::numeric_limits<double>::infinity();

const Colour line = rgb(0x404040);

// ---------------------------------------------------------------- legend

struct Item {
    double width, height;                             ///< pixels
    std::function<void(Image&, cv::Point2d)> draw;  ///< at its upper left corner
};

Item entry_item(const LegendEntry& entry, double unit)
{
    const double cap = text_cap * unit, small = small_cap * unit, indent = 28 * unit;
    const bool two_lines = !entry.detail.empty();
    const double width = indent + std::max(text_width(entry.name, cap), text_width(entry.detail, small));
    return {width, (two_lines ? 42 : 27) * unit, [=](Image& image, cv::Point2d at) {
                const cv::Rect swatch(cvRound(at.x), cvRound(at.y), whole(18 * unit), whole((two_lines ? 28 : 14) * unit));
                fill(image, swatch, entry.colour);
                outline(image, swatch, whole(0.8 * unit), muted);
                const double first = two_lines ? at.y + cap : at.y + 7 * unit + cap / 2;
                draw_text(image, entry.name, {at.x + indent, first}, {cap});
                draw_text(image, entry.detail, {at.x + indent, first + 17 * unit}, {small, muted});
            }};
}

Item arrow_item(const Legend& legend, double unit)
{
    const double cap = text_cap * unit, indent = 28 * unit;
    return {indent + text_width(legend.arrow, cap), 27 * unit,
            [=, text = legend.arrow, length = legend.arrow_length](Image& image, cv::Point2d at) {
                const double middle = 0.1 * std::max(0.0, length - smallest_arrow);  // more of an arrow is ahead of its centre
                draw_arrow(image, {at.x + (9 - middle) * unit, at.y + 7 * unit}, 0, length, unit);
                draw_text(image, text, {at.x + indent, at.y + 7 * unit + cap / 2}, {cap});
            }};
}

void draw_bar(Image& image, const cv::Rect& bar, const ColourScale& scale, double unit)
{
    const double low = scale.ticks.lowest(), high = scale.ticks.highest();
    for (int row = 0; row < bar.height; ++row)
        fill(image, {bar.x, bar.y + row, bar.width, 1}, scale.at(high + (low - high) * (row + 0.5) / bar.height));
    const int thickness = whole(unit), tick = whole(tick_length * unit);
    outline(image, bar, thickness, line);
    for (int i = 0; i < scale.ticks.count; ++i) {
        const double y = bar.y + bar.height * (high - scale.ticks.at(i)) / (high - low);
        fill(image, {bar.br().x + thickness, cvRound(y - thickness / 2.0), tick, thickness}, line);
        const cv::Point2d label(bar.br().x + tick + gap * unit, y + small_cap * unit / 2);
        draw_text(image, scale.ticks.label(i), label, {small_cap * unit});
    }
}

Item scale_item(const ColourScale& scale, double unit, double bar_height)
{
    const double cap = text_cap * unit, small = small_cap * unit, bar_width = 18 * unit;
    const double head = cap + (scale.detail.empty() ? 13 : 30) * unit;
    double width = std::max(text_width(scale.heading, cap), text_width(scale.detail, small));
    for (int i = 0; i < scale.ticks.count; ++i)
        width = std::max(width, bar_width + (tick_length + gap) * unit + text_width(scale.ticks.label(i), small));
    return {width, head + bar_height + 18 * unit, [=](Image& image, cv::Point2d at) {
                draw_text(image, scale.heading, {at.x, at.y + cap}, {cap});
                draw_text(image, scale.detail, {at.x, at.y + cap + 17 * unit}, {small, muted});
                draw_bar(image, {cvRound(at.x), cvRound(at.y + head), whole(bar_width), whole(bar_height)}, scale, unit);
            }};
}

std::vector<Item> legend_items(const Legend& legend, double unit, double bar_height)
{
    std::vector<Item> items;
    if (legend.scale) items.push_back(scale_item(*legend.scale, unit, bar_height * unit));
    for (const LegendEntry& entry : legend.entries) items.push_back(entry_item(entry, unit));
    if (!legend.arrow.empty()) items.push_back(arrow_item(legend, unit));
    return items;
}

/// A legend with its items in their places: one below the other, in a next column where column_height is passed.
struct Panel {
    std::vector<Item> items;
    std::vector<cv::Point2d> places;
    double width = 0, height = 0;
};

Panel panel_of(const Legend& legend, double unit, double column_height)
{
    const bool columns = column_height < infinite;
    const double top = legend.heading.empty() ? 0 : (text_cap + 15) * unit;
    Panel panel{legend_items(legend, unit, columns ? 92 : 220), {}, text_width(legend.heading, text_cap * unit), top};
    double x = 0, y = top, right = 0;
    for (const Item& item : panel.items) {
        if (y > top && y - top + item.height > column_height) {
            x = right + column_gap * unit;
            y = top;
        }
        panel.places.emplace_back(x, y);
        y += item.height;
        right = std::max(right, x + item.width);
        panel.width = std::max(panel.width, right);
        panel.height = std::max(panel.height, y);
    }
    return panel;
}

/// Three entries, or more where the columns would take more than the width.
double lowest_columns(const Legend& legend, double unit, double width)
{
    double height = 130;
    while (height < 1000 && panel_of(legend, unit, height * unit).width > width) height += 10;
    return height * unit;
}

// ---------------------------------------------------------------- axes

double widest_label(const Ticks& ticks, double cap)
{
    double widest = 0;
    for (int i = 0; i < ticks.count; ++i) widest = std::max(widest, text_width(ticks.label(i), cap));
    return widest;
}

/// Ticks at least `apart` pixels from each other, and what `needs` gives; one at least, whatever its label takes.
/// `scale` is in pixels per metre.
Ticks axis_ticks(double low, double high, double scale, double apart, const std::function<double(const Ticks&)>& needs)
{
    RoundStep step = round_up(apart / scale);
    Ticks ticks = ticks_within(low, high, step);
    while (ticks.count > 1 && needs(ticks) > step.value * scale) {
        step = round_up(step.value * 1.01);
        ticks = ticks_within(low, high, step);
    }
    while (ticks.count == 0) {
        step = round_down(step.value * 0.99);
        ticks = ticks_within(low, high, step);
        ticks.count = std::min(ticks.count, 1);
    }
    return ticks;
}

Ticks x_ticks(const View& view, double scale, double unit)
{
    const auto needs = [&](const Ticks& ticks) { return widest_label(ticks, small_cap * unit) + 28 * unit; };
    return axis_ticks(view.x0, view.x0 + view.width, scale, 70 * unit, needs);
}

Ticks y_ticks(const View& view, double scale, double unit)
{
    return axis_ticks(view.y0, view.y0 + view.height, scale, 45 * unit, [](const Ticks&) { return 0.0; });
}

// ---------------------------------------------------------------- layout

/// Room around the plot, pixels.
struct Margins {
    int left, right, top, bottom;
};

cv::Rect plot_in(const View& view, const Margins& margins, double width, double height)
{
    const double scale = std::min(width / view.width, height / view.height);
    return {margins.left, margins.top, whole(scale * view.width), whole(scale * view.height)};
}

Layout legend_beside(const Frame& frame, const Margins& margins, double unit)
{
    const Panel panel = panel_of(frame.legend, unit, infinite);
    const int between = std::max(margins.right, cvRound(26 * unit)), border = cvRound(margin * unit);
    const int panel_width = cvCeil(std::max(panel.width, bearing_width * unit));
    Layout layout;
    layout.plot = plot_in(frame.view, margins, frame.pixels - margins.left - between - panel_width - border,
                          frame.pixels - margins.top - margins.bottom);
    const double x = layout.plot.br().x + between, y = margins.top;
    const double height = std::max<double>(layout.plot.height, panel.height + (bearing_height + 20) * unit);
    layout.panel = {x, y};
    layout.column_height = infinite;
    layout.bearing = {x, y + height - bearing_height * unit};
    layout.size = {layout.plot.br().x + between + panel_width + border, margins.top + cvCeil(height) + margins.bottom};
    return layout;
}

Layout legend_below(const Frame& frame, const Margins& margins, double unit)
{
    const int border = cvRound(margin * unit), right = std::max(margins.right, border);
    const double width = frame.pixels - margins.left - right, bearing_at = width - bearing_width * unit;
    Layout layout;
    layout.column_height = lowest_columns(frame.legend, unit, bearing_at - column_gap * unit);
    const double needed = panel_of(frame.legend, unit, layout.column_height).height;
    const int panel_height = cvCeil(std::max(needed, bearing_height * unit)) + border / 2;
    layout.plot = plot_in(frame.view, margins, width, frame.pixels - margins.top - margins.bottom - panel_height);
    layout.panel = {static_cast<double>(margins.left), static_cast<double>(layout.plot.br().y + margins.bottom)};
    layout.bearing = layout.panel + cv::Point2d(bearing_at, 0);
    layout.size = {margins.left + layout.plot.width + right, layout.plot.br().y + margins.bottom + panel_height};
    return layout;
}

Layout arrange(const Frame& frame, const Margins& margins, double unit)
{
    constexpr double wide = 1.75;  // from here on a legend below leaves more room for the plot
    const bool is_wide = frame.view.width > wide * frame.view.height;
    Layout layout = is_wide ? legend_below(frame, margins, unit) : legend_beside(frame, margins, unit);
    layout.unit = unit;
    return layout;
}

/// Long titles shrink, then make narrow pictures wider; only what is wider than any picture is cut.
double title_height(const std::string& title, int width, double unit)
{
    const double room = width - 2 * margin * unit;
    return title_cap * unit * std::clamp(room / std::max(1.0, text_width(title, title_cap * unit)), 0.75, 1.0);
}

// ---------------------------------------------------------------- parts of the picture

void draw_title(Image& image, const std::string& title, double unit)
{
    const double cap = title_height(title, image.cols, unit);
    const std::string shown = cut_to(title, cap, image.cols - 2 * margin * unit + 1);
    draw_text(image, shown, {margin * unit, (margin + title_cap) * unit}, {cap});
}

void draw_axes(Image& image, const View& view, const Layout& layout)
{
    const cv::Rect& plot = layout.plot;
    const double unit = layout.unit, cap = small_cap * unit;
    const int thickness = whole(1.2 * unit), tick = whole(tick_length * unit);
    outline(image, plot, thickness, line);
    for (int i = 0; i < layout.x_ticks.count; ++i) {
        const double x = plot.x + (layout.x_ticks.at(i) - view.x0) / view.width * plot.width;
        fill(image, {cvRound(x - thickness / 2.0), plot.br().y, thickness, thickness + tick}, line);
        draw_text(image, layout.x_ticks.label(i), {x, plot.br().y + tick + gap * unit + cap}, {cap, ink, Align::Centre});
    }
    for (int i = 0; i < layout.y_ticks.count; ++i) {
        const double y = plot.y + (view.y0 + view.height - layout.y_ticks.at(i)) / view.height * plot.height;
        fill(image, {plot.x - thickness - tick, cvRound(y - thickness / 2.0), thickness + tick, thickness}, line);
        draw_text(image, layout.y_ticks.label(i), {plot.x - tick - gap * unit, y + cap / 2}, {cap, ink, Align::Right});
    }
    const double below_labels = plot.br().y + tick + (2 * gap + 3) * unit + 2 * cap;
    draw_text(image, "x, m", {plot.x + plot.width / 2.0, below_labels}, {cap, muted, Align::Centre});
    draw_text(image, "y, m", {plot.x - tick - gap * unit, plot.y - 17 * unit}, {cap, muted, Align::Right});
}

void draw_legend(Image& image, const Legend& legend, const Layout& layout)
{
    const Panel panel = panel_of(legend, layout.unit, layout.column_height);
    const double cap = text_cap * layout.unit;
    draw_text(image, legend.heading, layout.panel + cv::Point2d(0, cap), {cap});
    for (std::size_t i = 0; i < panel.items.size(); ++i) panel.items[i].draw(image, layout.panel + panel.places[i]);
}

std::string length_label(RoundStep length)
{
    if (length.value < 1000) return fixed(length.value, length.decimals) + " m";
    return fixed(length.value / 1000, length.value < 2600 && length.value > 2400 ? 1 : 0) + " km";
}

/// Scale bar, and north arrow to its right. `scale` is in pixels per metre.
void draw_bearing(Image& image, cv::Point2d at, double scale, double unit)
{
    const double bottom = at.y + (bearing_height - 1) * unit;
    const RoundStep length = round_down(longest_scale_bar * unit / scale);
    const int pixels = whole(length.value * scale), height = whole(6 * unit), thickness = whole(unit);
    const cv::Rect bar(cvRound(at.x) + thickness, cvRound(bottom) - height, pixels, height);
    fill(image, bar, white);
    fill(image, {bar.x, bar.y, pixels / 2, bar.height}, ink);
    outline(image, bar, thickness, ink);
    const cv::Point2d label(bar.x + pixels / 2.0, bar.y - 8 * unit);
    draw_text(image, length_label(length), label, {small_cap * unit, ink, Align::Centre});

    const double half = 8 * unit, needle = 26 * unit;
    const cv::Point2d tip(at.x + bearing_width * unit - half - unit, bottom - needle), notch(tip.x, tip.y + 0.75 * needle);
    draw_polygon(image, {tip, {tip.x - half, bottom}, notch}, ink, ink, unit);
    draw_polygon(image, {tip, {tip.x + half, bottom}, notch}, white, ink, unit);
    draw_text(image, "N", {tip.x, tip.y - 6 * unit}, {text_cap * unit, ink, Align::Centre});
}

}  // namespace

View with_room(View view)
{
    constexpr double thinnest = 12;
    const double height = std::max(view.height, view.width / thinnest), width = std::max(view.width, view.height / thinnest);
    return {view.x0 - (width - view.width) / 2, view.y0 - (height - view.height) / 2, width, height};
}

Colour ColourScale::at(double value) const
{
    const double share = (value - ticks.lowest()) / (ticks.highest() - ticks.lowest());
    return ramp[static_cast<std::size_t>(cvRound(std::clamp(share, 0.0, 1.0) * 255))];
}

Layout lay_out(const Frame& frame)
{
    const double unit = frame.pixels / 1000.0;
    const int top = cvRound((frame.title.empty() ? margin + 20 : margin + title_cap + 42) * unit);
    Margins margins{cvRound(70 * unit), 0, top, cvRound(62 * unit)};
    // Labels need ticks, ticks the scale, the scale the labels' width: a first guess of that width is close enough.
    Layout layout = arrange(frame, margins, unit);
    const double scale = layout.plot.width / frame.view.width, cap = small_cap * unit;
    const Ticks x = x_ticks(frame.view, scale, unit), y = y_ticks(frame.view, scale, unit);
    margins.left = cvCeil(std::max(widest_label(y, cap), text_width("y, m", cap)) + (margin + tick_length + gap) * unit);
    margins.right = cvCeil(widest_label(x, cap) / 2 + gap * unit);
    layout = arrange(frame, margins, unit);
    layout.x_ticks = x;
    layout.y_ticks = y;
    const double title = text_width(frame.title, title_height(frame.title, layout.size.width, unit)) + 2 * margin * unit;
    layout.size.width = std::clamp(cvCeil(title), layout.size.width, std::max(frame.pixels, layout.size.width));
    return layout;
}

Image draw_picture(const Frame& frame, const Layout& layout, const Image& plot)
{
    Image image(layout.size, white);
    plot.copyTo(image(layout.plot));
    draw_title(image, frame.title, layout.unit);
    draw_axes(image, frame.view, layout);
    draw_legend(image, frame.legend, layout);
    draw_bearing(image, layout.bearing, layout.plot.width / frame.view.width, layout.unit);
    return image;
}

void draw_arrow(Image& image, cv::Point2d centre, double yaw, double length, double unit)
{
    if (length < smallest_arrow) {
        draw_dot(image, centre, std::max(1.2, 2.2 * unit), white, ink, unit);
        return;
    }
    const cv::Point2d along = length * unit * cv::Point2d(std::cos(yaw), -std::sin(yaw)), left(along.y, -along.x);
    const cv::Point2d tail = centre - 0.4 * along;
    draw_polygon(image, {centre + 0.6 * along, tail + 0.36 * left, centre - 0.2 * along, tail - 0.36 * left}, white, ink,
                 1.4 * unit);
}

}  // namespace spawnfield
