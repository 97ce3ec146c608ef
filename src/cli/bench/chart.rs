//! What was measured as an SVG: a bar an engine, the shorter the faster, on a logarithmic scale.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::table::Measured;
use super::to_f64;

/// Pixels.
const WIDTH: u32 = 860;
const BAR: u32 = 26;
const MARGIN: u32 = 96;

/// A chart for each program, below each other.
pub(super) fn draw(measured: &[Measured]) -> String {
    let heights: Vec<u32> = measured
        .iter()
        .map(|measured| MARGIN.saturating_add(BAR.saturating_mul(u32::try_from(measured.rows.len()).unwrap_or(0))))
        .collect();
    let mut text = String::new();
    let size = (WIDTH, heights.iter().fold(0, |sum: u32, height| sum.saturating_add(*height)).max(1));
    {
        let mut rest = SVGBackend::with_string(&mut text, size).into_drawing_area();
        // Drawing into a string fails only where a chart has no room, and these have.
        let _ = rest.fill(&WHITE);
        for (measured, height) in measured.iter().zip(heights) {
            let (area, below) = rest.split_vertically(height);
            let _ = one(&area, measured);
            rest = below;
        }
        let _ = rest.present();
    }
    text
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn one(area: &Area<'_>, measured: &Measured) -> Result<(), Box<dyn std::error::Error>> {
    let bars: Vec<(&str, f64)> =
        measured.rows.iter().filter_map(|row| Some((row.engine, row.nanoseconds?.max(0.1)))).collect();
    if bars.is_empty() {
        return Ok(());
    }
    let (fastest, slowest) = measured.extremes();
    let (from, to) = (10f64.powf((fastest / 2.0).log10().floor()), slowest * 4.0);
    let title = format!("{}, {} rungs: nanoseconds a scan", measured.program, measured.rungs);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 18))
        .margin(10)
        .x_label_area_size(30)
        .y_label_area_size(130)
        .build_cartesian_2d((from..to).log_scale(), 0.0..to_f64(bars.len()))?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .y_labels(0)
        .x_label_formatter(&|nanoseconds| format!("{nanoseconds}"))
        .draw()?;
    for (number, (name, nanoseconds)) in bars.iter().enumerate() {
        let top = to_f64(bars.len()) - to_f64(number);
        let colour = if number == 0 { RGBColor(0x1B, 0x7F, 0x5C) } else { RGBColor(0x8A, 0x93, 0x9E) };
        let corners = [(from, top - 0.15), (*nanoseconds, top - 0.85)];
        chart.draw_series([Rectangle::new(corners, colour.filled())])?;
        let text = |size: i32| ("sans-serif", size).into_font().color(&BLACK);
        let value = format!(" {nanoseconds:.1} ({:.2})", nanoseconds / bars[0].1);
        chart.draw_series([Text::new(value, (*nanoseconds, top - 0.25), text(13))])?;
        let (x, y) = chart.backend_coord(&(from, top - 0.25));
        let (left, above) = area.get_base_pixel();
        let style = text(14).pos(Pos::new(HPos::Right, VPos::Top));
        area.draw(&Text::new((*name).to_owned(), (x - 6 - left, y - above), style))?;
    }
    Ok(())
}
