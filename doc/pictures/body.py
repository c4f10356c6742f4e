# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's Fig. 4: the deformed mesh coloured by stress, with ParaView.

Usage: pvbatch body.py RESULTS PICTURE
"""
import sys

from paraview.simple import (ColorBy, GetActiveViewOrCreate,
                             GetColorTransferFunction, GetScalarBar,
                             ResetCamera, SaveScreenshot, Show, WarpByVector,
                             XMLUnstructuredGridReader)

results, picture = sys.argv[1:]
view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [1400, 500]
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
view.OrientationAxesVisibility = 0

body = XMLUnstructuredGridReader(FileName=[results + "/body.vtu"])
warped = WarpByVector(Input=body, Vectors=["POINTS", "displacement"],
                      ScaleFactor=2)
shown = Show(warped, view)
shown.SetRepresentationType("Surface With Edges")
shown.EdgeColor = [0.2, 0.2, 0.2]
ColorBy(shown, ("CELLS", "von_mises"))
colours = GetColorTransferFunction("von_mises")
colours.ApplyPreset("Viridis (matplotlib)", True)
# The stress at the corners grows without bound with refinement: a range up to
# a part of the maximum shows the rest of the body.
top = 0.4 * warped.CellData["von_mises"].GetRange()[1]
colours.RescaleTransferFunction(0, top)
shown.SetScalarBarVisibility(view, True)
bar = GetScalarBar(colours, view)
bar.Title = "von Mises stress [GPa], displacement x 2"
bar.ComponentTitle = ""
bar.TitleColor = [0, 0, 0]
bar.LabelColor = [0, 0, 0]
bar.Orientation = "Horizontal"
bar.WindowLocation = "Lower Center"

view.CameraParallelProjection = 1
ResetCamera()
if body.GetDataInformation().GetBounds()[5] > 0:  # three-dimensional
    camera = view.GetActiveCamera()
    camera.Elevation(25)
    camera.Azimuth(20)
    ResetCamera()
camera = view.GetActiveCamera()
camera.SetParallelScale(camera.GetParallelScale() * 0.4)
SaveScreenshot(picture, view, ImageResolution=[1400, 500])
