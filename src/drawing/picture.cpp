#include "drawing/picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace spawnfield {
namespace {

// These lengths are in units. A unit is a thousandth of the picture's longer side.
constexpr double text_cap = 10.5, small_cap = 9.5, title_cap = 15;  // heights of capital letters
constexpr double margin = 18, tick_length = 6, gap = 7, column_gap = 30;
constexpr double bearing_width = 160, bearing_height = 54, longest_scale_bar = 110, caption_line = 25;
constexpr double infinite = std::numeric_limits<double>::infinity();

const Colour line = rgb(0x404040);

// ---------------------------------------------------------------- legend

struct Item {
    double width, height;                            ///< pixels
    std::function<void(Figure&, cv::Point2d)> draw;  ///< draws it at its upper left corner
};

Item entry_item(const LegendEntry& entry, double unit)
{
    const double cap = text_cap * unit, small = small_cap * unit, indent = 28 * unit;
    const bool two_lines = !entry.detail.empty();
    const double width = indent + std::max(text_width(entry.name, cap), text_width(entry.detail, small));
    return {width, (two_lines ? 42 : 27) * unit, [=](Figure& figure, cv::Point2d corner) {
                const cv::Rect swatch(cvRound(corner.x), cvRound(corner.y), whole(18 * unit),
                                      whole((two_lines ? 28 : 14) * unit));
                fill(figure, swatch, entry.colour);
                outline(figure, swatch, whole(0.8 * unit), muted);
                const double first = two_lines ? corner.y + cap : corner.y + 7 * unit + cap / 2;
                draw_text(figure, entry.name, {corner.x + indent, first}, {cap});
                draw_text(figure, entry.detail, {corner.x + indent, first + 17 * unit}, {small, muted});
            }};
}

Item symbol_item(const LegendSymbol& symbol, double unit)
{
    const double cap = text_cap * unit, indent = symbol.draw ? (symbol_size + 10) * unit : 0;
    return {indent + text_width(symbol.name, cap), 27 * unit, [=](Figure& figure, cv::Point2d corner) {
                if (symbol.draw) symbol.draw(figure, {corner.x + symbol_size / 2 * unit, corner.y + 7 * unit});
                draw_text(figure, symbol.name, {corner.x + indent, corner.y + 7 * unit + cap / 2}, {cap});
            }};
}

/// Returns the ends of the scale, and the ticks that are not too near to them, with their labels.
std::vector<std::pair<double, std::string>> bar_labels(const ColourScale& scale, double height, double unit)
{
    const double apart = 1.6 * small_cap * unit / height * (scale.high - scale.low),
                 same = 1e-6 * (scale.high - scale.low);
    const auto near = [](double a, double b, double distance) { return std::abs(a - b) < distance; };
    std::vector<std::pair<double, std::string>> labels;
    for (const double end : {scale.low, scale.high}) {
        std::string text = fixed(end, scale.ticks.decimals + 1);
        for (int i = 0; i < scale.ticks.count; ++i)
            if (near(scale.ticks.value(i), end, same)) text = scale.ticks.label(i);
        labels.emplace_back(end, text);
    }
    for (int i = 0; i < scale.ticks.count; ++i) {
        const double tick = scale.ticks.value(i);
        if (!near(tick, scale.low, apart) && !near(tick, scale.high, apart))
            labels.emplace_back(tick, scale.ticks.label(i));
    }
    return labels;
}

void draw_bar(Figure& figure, const cv::Rect& bar, const ColourScale& scale, double unit)
{
    const double low = scale.low, high = scale.high;
    Image colours(bar.size());
    for (int row = 0; row < bar.height; ++row)
        colours.row(row) = scale.colour(high + (low - high) * (row + 0.5) / bar.height);
    draw_image(figure, bar.tl(), colours);
    const int thickness = whole(unit), tick = whole(tick_length * unit);
    outline(figure, bar, thickness, line);
    for (const auto& [value, label] : bar_labels(scale, bar.height, unit)) {
        const double y = bar.y + bar.height * (high - value) / (high - low);
        fill(figure, {bar.br().x + thickness, cvRound(y - thickness / 2.0), tick, thickness}, line);
        const cv::Point2d place(bar.br().x + tick + gap * unit, y + small_cap * unit / 2);
        draw_text(figure, label, place, {small_cap * unit});
    }
}

Item scale_item(const ColourScale& scale, double unit, double bar_height)
{
    const double cap = text_cap * unit, small = small_cap * unit, bar_width = 18 * unit;
    const double head = cap + (scale.detail.empty() ? 13 : 30) * unit;
    double width = std::max(text_width(scale.heading, cap), text_width(scale.detail, small));
    for (const auto& [value, label] : bar_labels(scale, bar_height, unit))
        width = std::max(width, bar_width + (tick_length + gap) * unit + text_width(label, small));
    return {width, head + bar_height + 18 * unit, [=](Figure& figure, cv::Point2d corner) {
                draw_text(figure, scale.heading, {corner.x, corner.y + cap}, {cap});
                draw_text(figure, scale.detail, {corner.x, corner.y + cap + 17 * unit}, {small, muted});
                draw_bar(figure, {cvRound(corner.x), cvRound(corner.y + head), whole(bar_width), whole(bar_height)},
                         scale, unit);
            }};
}

std::vector<Item> legend_items(const Legend& legend, double unit, double bar_height)
{
    std::vector<Item> items;
    if (legend.scale) items.push_back(scale_item(*legend.scale, unit, bar_height * unit));
    for (const LegendEntry& entry : legend.entries) items.push_back(entry_item(entry, unit));
    for (const LegendSymbol& symbol : legend.symbols) items.push_back(symbol_item(symbol, unit));
    return items;
}

/// A legend with its items in their places: one below the other, in a new column whenever column_height is exceeded.
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

/// Returns the smallest height of the legend's columns, pixels, at which they fit into the width: room for three
/// entries, or for more.
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

/// Returns ticks at distances of at least `apart` pixels and at least needs(ticks) pixels. Returns at least one tick,
/// even if its label is wider than the axis. `scale` is in pixels per metre.
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

Layout legend_beside(const PictureFrame& frame, const Margins& margins, double unit)
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

Layout legend_below(const PictureFrame& frame, const Margins& margins, double unit)
{
    const int border = cvRound(margin * unit), right = std::max(margins.right, border);
    const double width = frame.pixels - margins.left - right, bearing_x = width - bearing_width * unit;
    Layout layout;
    layout.column_height = lowest_columns(frame.legend, unit, bearing_x - column_gap * unit);
    const double needed = panel_of(frame.legend, unit, layout.column_height).height;
    const int panel_height = cvCeil(std::max(needed, bearing_height * unit)) + border / 2;
    layout.plot = plot_in(frame.view, margins, width, frame.pixels - margins.top - margins.bottom - panel_height);
    layout.panel = {static_cast<double>(margins.left), static_cast<double>(layout.plot.br().y + margins.bottom)};
    layout.bearing = layout.panel + cv::Point2d(bearing_x, 0);
    layout.size = {margins.left + layout.plot.width + right, layout.plot.br().y + margins.bottom + panel_height};
    return layout;
}

Layout arrange(const PictureFrame& frame, const Margins& margins, double unit)
{
    constexpr double wide = 1.75;  // wider views have more room for the plot if the legend is below
    const bool is_wide = frame.view.width > wide * frame.view.height;
    Layout layout = is_wide ? legend_below(frame, margins, unit) : legend_beside(frame, margins, unit);
    layout.unit = unit;
    return layout;
}

/// Returns the height of the capitals of a title or caption, pixels. A long line is made smaller, then a narrow picture
/// is made wider. Only a line that is still too wide is cut.
double line_height(const std::string& text, double cap, int width, double unit)
{
    const double room = width - 2 * margin * unit;
    return cap * unit * std::clamp(room / std::max(1.0, text_width(text, cap * unit)), 0.75, 1.0);
}

// ---------------------------------------------------------------- parts of the picture

void draw_title(Figure& figure, const PictureFrame& frame, double unit)
{
    const double room = figure.size.width - 2 * margin * unit + 1;
    const auto write = [&](const std::string& text, double cap, double y, Colour colour) {
        const double shown_cap = line_height(text, cap, figure.size.width, unit);
        draw_text(figure, cut_to(text, shown_cap, room), {margin * unit, y * unit}, {shown_cap, colour});
    };
    write(frame.title, title_cap, margin + title_cap, ink);
    write(frame.caption, text_cap, margin + title_cap + caption_line, muted);
}

void draw_axes(Figure& figure, const View& view, const Layout& layout)
{
    const cv::Rect& plot = layout.plot;
    const double unit = layout.unit, cap = small_cap * unit;
    const int thickness = whole(1.2 * unit), tick = whole(tick_length * unit);
    outline(figure, plot, thickness, line);
    for (int i = 0; i < layout.x_ticks.count; ++i) {
        const double x = plot.x + (layout.x_ticks.value(i) - view.x0) / view.width * plot.width;
        fill(figure, {cvRound(x - thickness / 2.0), plot.br().y, thickness, thickness + tick}, line);
        draw_text(figure, layout.x_ticks.label(i), {x, plot.br().y + tick + gap * unit + cap},
                  {cap, ink, Align::Centre});
    }
    for (int i = 0; i < layout.y_ticks.count; ++i) {
        const double y = plot.y + (view.y0 + view.height - layout.y_ticks.value(i)) / view.height * plot.height;
        fill(figure, {plot.x - thickness - tick, cvRound(y - thickness / 2.0), thickness + tick, thickness}, line);
        draw_text(figure, layout.y_ticks.label(i), {plot.x - tick - gap * unit, y + cap / 2}, {cap, ink, Align::Right});
    }
    const double below_labels = plot.br().y + tick + (2 * gap + 3) * unit + 2 * cap;
    draw_text(figure, "x, m", {plot.x + plot.width / 2.0, below_labels}, {cap, muted, Align::Centre});
    draw_text(figure, "y, m", {plot.x - tick - gap * unit, plot.y - 17 * unit}, {cap, muted, Align::Right});
}

void draw_legend(Figure& figure, const Legend& legend, const Layout& layout)
{
    const Panel panel = panel_of(legend, layout.unit, layout.column_height);
    const double cap = text_cap * layout.unit;
    draw_text(figure, legend.heading, layout.panel + cv::Point2d(0, cap), {cap});
    for (std::size_t i = 0; i < panel.items.size(); ++i) panel.items[i].draw(figure, layout.panel + panel.places[i]);
}

std::string length_label(RoundStep length)
{
    if (length.value < 1000) return fixed(length.value, length.decimals) + " m";
    return fixed(length.value / 1000, length.value < 2600 && length.value > 2400 ? 1 : 0) + " km";
}

/// Draws the scale bar, and the north arrow to its right. `scale` is in pixels per metre.
void draw_bearing(Figure& figure, cv::Point2d corner, double scale, double unit)
{
    const double bottom = corner.y + (bearing_height - 1) * unit;
    const RoundStep length = round_down(longest_scale_bar * unit / scale);
    const int pixels = whole(length.value * scale), height = whole(6 * unit), thickness = whole(unit);
    const cv::Rect bar(cvRound(corner.x) + thickness, cvRound(bottom) - height, pixels, height);
    fill(figure, bar, white);
    fill(figure, {bar.x, bar.y, pixels / 2, bar.height}, ink);
    outline(figure, bar, thickness, ink);
    const cv::Point2d label(bar.x + pixels / 2.0, bar.y - 8 * unit);
    draw_text(figure, length_label(length), label, {small_cap * unit, ink, Align::Centre});

    const double half = 8 * unit, needle = 26 * unit;
    const cv::Point2d tip(corner.x + bearing_width * unit - half - unit, bottom - needle),
        notch(tip.x, tip.y + 0.75 * needle);
    draw_polygon(figure, {tip, {tip.x - half, bottom}, notch}, ink, ink, unit);
    draw_polygon(figure, {tip, {tip.x + half, bottom}, notch}, white, ink, unit);
    draw_text(figure, "N", {tip.x, tip.y - 6 * unit}, {text_cap * unit, ink, Align::Centre});
}

}  // namespace

View with_room(View view)
{
    constexpr double thinnest = 12;
    const double height = std::max(view.height, view.width / thinnest),
                 width = std::max(view.width, view.height / thinnest);
    return {view.x0 - (width - view.width) / 2, view.y0 - (height - view.height) / 2, width, height};
}

Colour ColourScale::colour(double value) const
{
    const double share = (value - low) / (high - low);
    return ramp[static_cast<std::size_t>(cvRound(std::clamp(share, 0.0, 1.0) * 255))];
}

ColourScale scale_between(const std::string& heading, double low, double high, const Ramp& ramp)
{
    if (!(high - low > 1e-6 * std::max(1.0, std::abs(high)))) {
        low -= 0.5;
        high += 0.5;
    }
    return {heading, "", ticks_within(low, high, round_up((high - low) / 6)), ramp, low, high};
}

Layout lay_out(const PictureFrame& frame)
{
    const double unit = frame.pixels / 1000.0;
    const double head = frame.title.empty() ? 20 : title_cap + 42;
    const int top = cvRound((margin + head + (frame.caption.empty() ? 0 : caption_line)) * unit);
    Margins margins{cvRound(70 * unit), 0, top, cvRound(62 * unit)};
    // Labels depend on the ticks, ticks on the scale, and the scale on the labels' width. A first guess of that width
    // is close enough.
    Layout layout = arrange(frame, margins, unit);
    const double scale = layout.plot.width / frame.view.width, cap = small_cap * unit;
    const Ticks x = x_ticks(frame.view, scale, unit), y = y_ticks(frame.view, scale, unit);
    margins.left = cvCeil(std::max(widest_label(y, cap), text_width("y, m", cap)) +
                          (margin + tick_length + gap) * unit);
    margins.right = cvCeil(widest_label(x, cap) / 2 + gap * unit);
    layout = arrange(frame, margins, unit);
    layout.x_ticks = x;
    layout.y_ticks = y;
    const auto width_of = [&](const std::string& text, double height) {
        return text_width(text, line_height(text, height, layout.size.width, unit)) + 2 * margin * unit;
    };
    const double wanted = std::max(width_of(frame.title, title_cap), width_of(frame.caption, text_cap));
    layout.size.width = std::clamp(cvCeil(wanted), layout.size.width, std::max(frame.pixels, layout.size.width));
    return layout;
}

void draw_surroundings(Figure& figure, const PictureFrame& frame, const Layout& layout)
{
    draw_title(figure, frame, layout.unit);
    draw_axes(figure, frame.view, layout);
    draw_legend(figure, frame.legend, layout);
    draw_bearing(figure, layout.bearing, layout.plot.width / frame.view.width, layout.unit);
}

Image draw_picture(const PictureFrame& frame, const Layout& layout, const Image& plot)
{
    Figure figure{layout.size, {}};
    draw_image(figure, layout.plot.tl(), plot);
    draw_surroundings(figure, frame, layout);
    return paint(figure);
}

}  // namespace spawnfield
