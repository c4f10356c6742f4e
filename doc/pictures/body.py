# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deformed body coloured by von Mises stress and, in 3D, its contact
boundary from the foundation's side, with ParaView.

Usage: pvbatch body.py RESULTS PICTURE [CONTACT_PICTURE]
"""
import sys

import numpy
from paraview import servermanager
from paraview.simple import (ColorBy, CreateView, GetColorTransferFunction,
                             GetScalarBar, ResetCamera, SaveScreenshot, Show,
                             WarpByVector, XMLUnstructuredGridReader)
from vtk.util.numpy_support import vtk_to_numpy

# The largest displacement in the picture, relative to the body's size.
LARGEST_SHOWN = 0.06
MOST_CELLS_WITH_EDGES = 3000
results, picture = sys.argv[1:3]


def new_view():
    view = CreateView("RenderView")
    view.ViewSize = [1400, 500]
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    return view


def add_bar(shown, view, field, title):
    colours = GetColorTransferFunction(field)
    colours.ApplyPreset("Viridis (matplotlib)", True)
    shown.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(colours, view)
    bar.Title = title
    bar.ComponentTitle = ""
    bar.TitleColor = [0, 0, 0]
    bar.LabelColor = [0, 0, 0]
    bar.Orientation = "Horizontal"
    bar.WindowLocation = "Lower Center"
    return colours


def size_of(bounds):
    return max(bounds[2 * d + 1] - bounds[2 * d] for d in range(3))


def save(view, name, bounds, turn=()):
    camera = view.GetActiveCamera()
    ResetCamera(view)
    for rotate, angle in turn:
        getattr(camera, rotate)(angle)
    ResetCamera(view)
    # ParaView leaves room for a sphere around all; the pictures are wide.
    lengths = sorted(bounds[2 * d + 1] - bounds[2 * d] for d in range(3))
    height = max(lengths[1], lengths[2] * 500 / 1400)
    camera.SetParallelScale(0.75 * height)
    SaveScreenshot(name, view, ImageResolution=[1400, 500])


body = XMLUnstructuredGridReader(FileName=[results + "/body.vtu"])
body.UpdatePipeline()
bounds = body.GetDataInformation().GetBounds()
is_solid = bounds[5] > bounds[4]
largest = body.PointData["displacement"].GetRange(-1)[1]
scale = 1.
if largest > 0.:
    scale = LARGEST_SHOWN * size_of(bounds) / largest
    # One digit, so that it can be said.
    scale = float(f"{scale:.0e}") if scale < 1. else float(f"{scale:.1g}")

view = new_view()
warped = WarpByVector(Input=body, Vectors=["POINTS", "displacement"],
                      ScaleFactor=scale)
shown = Show(warped, view)
if body.GetDataInformation().GetNumberOfCells() < MOST_CELLS_WITH_EDGES:
    shown.SetRepresentationType("Surface With Edges")
shown.EdgeColor = [0.2, 0.2, 0.2]
ColorBy(shown, ("CELLS", "von_mises"))
colours = add_bar(shown, view, "von_mises",
                  f"von Mises stress, displacement x {scale:g}")
# The stress at corners grows without bound with refinement: what few cells have
# is left out of the range.
stresses = vtk_to_numpy(
    servermanager.Fetch(body).GetCellData().GetArray("von_mises"))
colours.RescaleTransferFunction(0, float(numpy.quantile(stresses, 0.98)))
save(view, picture, bounds,
     [("Elevation", 25), ("Azimuth", 20)] if is_solid else [])

if is_solid and len(sys.argv) > 3:
    contact = XMLUnstructuredGridReader(FileName=[results + "/contact.vtu"])
    contact.UpdatePipeline()
    view = new_view()
    shown = Show(contact, view)
    shown.SetRepresentationType("Surface")
    ColorBy(shown, ("POINTS", "gap"))
    add_bar(shown, view, "gap", "opening")
    around = contact.GetDataInformation().GetBounds()
    # Along the direction in which it is thinnest.
    lengths = [around[2 * d + 1] - around[2 * d] for d in range(3)]
    thin = lengths.index(min(lengths))
    turn = {0: [("Azimuth", 90)], 1: [("Elevation", 89.9), ("Roll", 180)], 2: []}[thin]
    save(view, sys.argv[3], around, turn)
