#pragma once
/// \file ExtractionOptions.h
/// \brief The settings of the extraction, with units, defaults and sources.

#include <string>
#include <vector>

#include <polemcl/export.h>

namespace polemcl {

class Binder;

enum class ExtractionMethod { rangeImage, scanLine };

/// \brief Where the paper's text and its authors' code differ, in five details.
enum class ExtractionDetails {
  /// Points outside the image are dropped, and it closes at ±180°. Pixels of the foreground have
  /// no nearer side neighbour outside the cluster. Algebraic fit (Kåsa). The free space is four
  /// squares at the corners of the box of the fit.
  mended,
  /// As the text: as above, but all side neighbours outside the cluster must be farther, and there
  /// must be some. The free space is what is nearer than its width to the circle around that box.
  paper,
  /// As the code: points outside the image go to its border pixels. The image is open, and its
  /// first and last rows and columns hold no pixels of clusters. The radius is the mean distance
  /// to the centre of the fit. The two squares at lower y are cut to the height
  /// `ring - 2 (R + margin)` by a sign slip.
  authors
};

/// \brief The paper's Algorithm 1. `[range_image]` in INI files; departures are named options.
///
/// Heights are those of the authors for KITTI, counted from the ground, 1.73 m below that LiDAR.
/// The exception is `minTop`: the authors mean a height above ground, but compare it with z.
struct POLEMCL_EXPORT RangeImageOptions {
  int rows = 0;                     ///< px; 0: a row for each ring; fewer where rings are not even
  int columns = 0;                  ///< px; 0: 500, as the paper, or the sensor's if it has fewer
  double fovUp = 0, fovDown = 0;    ///< rad; both 0: from the uppermost to the lowest ring
  double minZ = 0.43, maxZ = 7.73;  ///< height cut, m; see `heights_above_ground`
  double maxRange = 50;             ///< m
  double epsilon = 0.2;             ///< ε: range step inside a cluster, m
  int minPixels = 3;                ///< ζ: clusters need strictly more pixels
  int maxWidthPx = 10;              ///< px
  double foreground = 0.7;          ///< δ: least share of pixels not behind a side neighbour
  double minTop = 1.73;             ///< α, m
  double maxBottom = 3.23;          ///< β, m
  double minHeight = 0.6;           ///< γ, m
  double fitMaxZ = 4.73;            ///< highest point of the fit, m
  double freeRing = 0.5;            ///< width of the free space, m
  bool heightsAboveGround =
      true;  ///< true: z + `height_m`; false: z in the sensor frame, as the authors' code
  /// Origin of the range image. `sensor`: the optical centre, as in the paper; `cloud`: the origin
  /// of the clouds, whatever `[sensor] origin` says (authors' code: NCLT's body frame).
  std::string projectFrom = "sensor";
  /// true: y counts to the right in the image (authors' code for NCLT, which turns z over only).
  bool mirrored = false;
  /// m; the files hold multiples of this, and the exact ones are used instead of those rounded to
  /// float (NCLT: 0.005); 0: coordinates as they are.
  double coordinateStep = 0;
  /// true: projection and fit in float (authors' code for KITTI); false: in double.
  bool singlePrecision = false;
  ExtractionDetails details = ExtractionDetails::mended;
  /// \name Constants of the method; tests change them
  /// @{
  double minAspect = 1;                      ///< least h/w, px
  double minRadius = 0.02, maxRadius = 0.4;  ///< b, a, m
  double fitMargin = 0.1;                    ///< box for the fit: ± (R + margin), m
  int minFitPoints = 6;
  double freeShare = 0.15;  ///< μ: allowed points there as a share of the fitted ones
  /// @}
};

POLEMCL_EXPORT void bind(Binder& binder, RangeImageOptions& options);  ///< `[range_image]`

/// \brief Our method: scan lines of real beams. `[scan_line]` in INI files.
struct POLEMCL_EXPORT ScanLineOptions {
  double maxWidth = 0.9;     ///< greatest width of a segment of a pole, m
  double connectStep = 0.2;  ///< greatest step in range between neighbours in a segment, m
  double edgeStep = 0.35;    ///< least step in range from a segment's edge to what lies behind, m
  double stackReach = 0.3;   ///< greatest horizontal step between segments of a pole, m
  double stackGap = 1.2;     ///< greatest vertical step between them, m (or two beams)
  double minTop = 2.0;       ///< least height of the top, m above local ground (`min_top_m`)
  double maxBottom = 2.2;    ///< greatest height of the lowest return, m
  double minHeight = 0.5;    ///< least visible height, m
  double minRadius = 0.02;   ///< m
  double maxRadius = 0.45;   ///< m
  int minPoints = 5;         ///< least number of returns of a pole
  double maxTilt = 0.2;      ///< greatest tilt of the axis from the vertical, rad; no setting
  double maxScatter = 0.12;  ///< greatest rms distance of the segments from the axis, m
  double minSpacing = 0.4;   ///< two poles nearer than this: the less confident is dropped, m
  double minConfidence = 0.65;  ///< poles with a lower confidence are refused
  double maxRange = 40;         ///< poles farther away are not looked for, m
};

POLEMCL_EXPORT void bind(Binder& binder, ScanLineOptions& options);  ///< `[scan_line]`

/// \brief `[extraction]` in INI files.
struct POLEMCL_EXPORT ExtractionOptions {
  ExtractionMethod method = ExtractionMethod::scanLine;
  RangeImageOptions rangeImage;
  ScanLineOptions scanLine;
};

POLEMCL_EXPORT void bind(Binder& binder,
                         ExtractionOptions& options);  ///< `[extraction]` and the two above

}  // namespace polemcl
