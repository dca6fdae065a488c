"""Reports of cloning in words."""

from __future__ import annotations

from risorius.cloning import CloneReport, Comparison

__all__ = ["comparison_rows", "report_lines"]

# Shapes whose landmarks turn off the source's direction more than this are named.
_TURNED = 0.9
Cell = str | int | float | None


def report_lines(report: CloneReport) -> list[str]:
    """Return what a person wants to know of a clone."""
    lines = [
        f"{report.landmark_count} landmarks in common, {report.landmark_miss:.1f} mm apart after "
        f"scaling by {report.scale:.3f}",
        f"skins {report.residual_mean:.2f} mm apart on average, {report.residual_largest:.1f} mm "
        f"at most; {report.unmapped} vertices without a partner stay at rest",
    ]
    turned = [
        f"{shape.name} ({shape.kept:.2f})"
        for shape in report.shapes
        if shape.kept is not None and shape.kept < _TURNED
    ]
    if turned:
        lines.append(f"landmarks move differently in: {', '.join(turned)}")
    return lines


def comparison_rows(comparison: Comparison) -> list[dict[str, Cell]]:
    """Return one row for each shape: column name -> value."""
    return [
        {
            "shape": shape.name,
            "motion": shape.motion,
            "absolute": shape.absolute,
            "cosine": shape.cosine,
            "amplitude": shape.amplitude,
            "rough": shape.roughness,
            "lost": shape.lost,
            "invented": shape.invented,
            "gap": shape.gap,
            "gap_first": shape.gap_first,
            "lids": shape.lids,
            "lids_first": shape.lids_first,
        }
        for shape in comparison.shapes
    ]
