# SPDX-License-Identifier: BSD-3-Clause
# Made by scripts/python-stubs from the docstrings of the extension.
import enum
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Path = str | os.PathLike[str]
_Options = Mapping[str, Any] | _Path | None

__version__: str

class InputError(ValueError):
    """An error in what was given: a file, a key, a row, an option, the size of an image. One line that names it and says what was expected."""

class DetectionMethod(str, enum.Enum):
    """Means by which a pad was recognised: its ring with a cross, a part of it, decoded tags, the
    letter of a helipad, its appearance at the expected place, or a detector of one's own.
    """
    RING = "ring"
    PARTIAL = "partial"
    TAGS = "tags"
    LETTER = "letter"
    FOLLOWED = "followed"
    OTHER = "other"

class LandingStage(str, enum.Enum):
    """Stages of a search for a pad, in order. Before FOUND: where the best candidate fell
    (TargetReport.reached).
    """
    BINARIZE = "binarize"
    AREAS = "areas"
    RING = "ring"
    CROSS = "cross"
    MATCH = "match"
    LOCATE = "locate"
    FOUND = "found"

class MeasurementFate(str, enum.Enum):
    """What a TargetTracker did with a measurement."""
    STARTED = "started"
    ACCEPTED = "accepted"
    INVALID = "invalid"
    TOO_OLD = "too old"
    FAR_FROM_THE_TRACK = "far from the track"

class TrackState(str, enum.Enum):
    """State of a track: never seen, seen, predicted, or lost."""
    SEARCHING = "searching"
    TRACKING = "tracking"
    PREDICTING = "predicting"
    LOST = "lost"

class PoseLookup(str, enum.Enum):
    """Whether a PoseHistory has a pose at a time, or why not."""
    FOUND = "found"
    NO_POSES = "no poses"
    TOO_OLD = "too old"
    TOO_NEW = "too new"
    GAP = "gap"
    PREDICTED = "predicted"
    NO_REPORT_OF_THE_GIMBAL = "no report of the gimbal"

class PositionMethod(str, enum.Enum):
    """What the distance to a pad comes from: its size, or the altitude."""
    SIZE = "size"
    ALTITUDE = "altitude"

class Completeness(str, enum.Enum):
    """Whether an object is seen whole, cut off by the image, or merged with another one."""
    WHOLE = "whole"
    CUT_OFF = "cut off"
    MERGED = "merged"

class ObjectShape(str, enum.Enum):
    """Shape of a coloured object."""
    DISC = "disc"
    CUBOID = "cuboid"
    BAR = "bar"

class PoseStatus(str, enum.Enum):
    """Whether a pose was added to a history, or why not."""
    OK = "ok"
    OUT_OF_ORDER = "out of order"
    INVALID = "invalid"

class DistortionModel(str, enum.Enum):
    """Distortion of a lens, by the words of a calibration file."""
    NONE = "none"
    RADIAL_TANGENTIAL = "radial-tangential"
    EQUIDISTANT = "equidistant"

class PixelFormat(str, enum.Enum):
    """Format of an image: gray (rows, columns) or BGR (rows, columns, 3)."""
    GRAY = "gray"
    BGR = "bgr"

class RigidTransform:
    """A rigid transform from frame A to frame B: b_from_a @ p_in_a is p_in_b. Named by cancellation:
    c_from_a = c_from_b @ b_from_a. Metres.
    """
    def __init__(self, *, translation: ArrayLike = ..., quaternion: ArrayLike = ...) -> None: ...
    def replace(self, *, translation: ArrayLike = ..., quaternion: ArrayLike = ...) -> RigidTransform: ...
    @property
    def translation(self) -> NDArray[np.float64]:
        """float64 of 3, m."""
    @property
    def quaternion(self) -> NDArray[np.float64]:
        """The rotation as a unit quaternion, float64 of 4: w, x, y, z."""
    @property
    def rotation(self) -> NDArray[np.float64]:
        """The rotation as a matrix, float64 3 x 3."""
    @property
    def matrix(self) -> NDArray[np.float64]:
        """The transform as a matrix, float64 4 x 4."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""
    @staticmethod
    def from_matrix(matrix: ArrayLike) -> RigidTransform:
        """Returns the transform of a 4 x 4 matrix. Raises InputError where it is not rigid."""
    def inverse(self) -> RigidTransform:
        """Returns a_from_b."""
    @overload
    def __matmul__(self, other: RigidTransform) -> RigidTransform: ...
    @overload
    def __matmul__(self, points: ArrayLike) -> NDArray[np.float64]:
        """Composes transforms, or transforms points: N x 3 or 3, m."""

class BodyMotion:
    """Motion of the body."""
    def __init__(self, *, velocity_in_world: ArrayLike = ..., rate_in_body: ArrayLike = ...) -> None: ...
    def replace(self, *, velocity_in_world: ArrayLike = ..., rate_in_body: ArrayLike = ...) -> BodyMotion: ...
    @property
    def velocity_in_world(self) -> NDArray[np.float64]:
        """float64 of 3, m/s, ENU."""
    @property
    def rate_in_body(self) -> NDArray[np.float64]:
        """Angular velocity, float64 of 3, rad/s, FLU."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class PoseSample:
    """Pose of the body (FLU) in the world (ENU) at an instant of the navigation's clock."""
    def __init__(self, *, time_ns: int = ..., world_from_body: RigidTransform = ..., motion: BodyMotion | None = ..., time_sigma_s: float = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., world_from_body: RigidTransform = ..., motion: BodyMotion | None = ..., time_sigma_s: float = ...) -> PoseSample: ...
    @property
    def time_ns(self) -> int:
        """int, ns."""
    @property
    def world_from_body(self) -> RigidTransform:
        """RigidTransform."""
    @property
    def motion(self) -> BodyMotion | None:
        """BodyMotion where the navigation reports it, or None."""
    @property
    def time_sigma_s(self) -> float:
        """Standard deviation of time_ns, s."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class PoseUncertainty:
    """Standard deviations per axis that a predicted pose has beyond those of the samples."""
    def __init__(self, *, position_m: float = ..., attitude_rad: float = ...) -> None: ...
    def replace(self, *, position_m: float = ..., attitude_rad: float = ...) -> PoseUncertainty: ...
    @property
    def position_m(self) -> float:
        """m."""
    @property
    def attitude_rad(self) -> float:
        """rad."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class PoseHistory:
    """The latest poses of the UAV in order of time, with interpolation. The newest sample replaces the
    oldest.
    """
    def __init__(self, capacity: int = ..., max_gap_s: float = ...) -> None:
        """Keeps up to 'capacity' samples. Between two of them more than 'max_gap_s' apart there is no
        pose.
        """
    def add(self, sample: PoseSample) -> PoseStatus:
        """Adds a PoseSample. Returns 'ok', 'out of order' or 'invalid'; what is not ok changes nothing."""
    def check(self, time_ns: int) -> PoseLookup:
        """Returns 'found' where lookup has a pose, or why it has none: 'no poses', 'too old', 'too new',
        'gap'.
        """
    def lookup(self, time_ns: int) -> RigidTransform | None:
        """Returns world_from_body at 'time_ns', interpolated between two samples, or None."""
    def smooth(self, time_ns: int, half_window_s: float) -> RigidTransform | None:
        """The same with less noise: from the samples up to 'half_window_s' before and after."""
    def __len__(self) -> int: ...

class CameraIntrinsics:
    """A lens and the size of its images. Pixels: integer coordinates are the pixels' centres."""
    def __init__(self, *, width_px: int = ..., height_px: int = ..., fx_px: float = ..., fy_px: float = ..., cx_px: float = ..., cy_px: float = ..., distortion_model: DistortionModel | str = ..., distortion: list[float] = ...) -> None: ...
    def replace(self, *, width_px: int = ..., height_px: int = ..., fx_px: float = ..., fy_px: float = ..., cx_px: float = ..., cy_px: float = ..., distortion_model: DistortionModel | str = ..., distortion: list[float] = ...) -> CameraIntrinsics: ...
    @property
    def width_px(self) -> int:
        """Width of the image, px."""
    @property
    def height_px(self) -> int:
        """Height of the image, px."""
    @property
    def fx_px(self) -> float:
        """Focal length along x, px."""
    @property
    def fy_px(self) -> float:
        """Focal length along y, px."""
    @property
    def cx_px(self) -> float:
        """Principal point, px."""
    @property
    def cy_px(self) -> float:
        """Principal point, px."""
    @property
    def distortion_model(self) -> DistortionModel:
        """'none', 'radial-tangential' (OpenCV's order: k1 k2 p1 p2 [k3 [k4 k5 k6]]) or 'equidistant'
        (OpenCV's fisheye, Kalibr: k1 k2 k3 k4).
        """
    @property
    def distortion(self) -> list[float]:
        """Coefficients: 0, 4, 5 or 8, depending on the model."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class CameraCalibration:
    """The content of a camera's calibration file: the lens, the mount on the body, and the offset of
    the clock.
    """
    def __init__(self, *, intrinsics: CameraIntrinsics = ..., body_from_camera: RigidTransform | None = ..., clock_offset_s: float | None = ..., name: str = ...) -> None: ...
    def replace(self, *, intrinsics: CameraIntrinsics = ..., body_from_camera: RigidTransform | None = ..., clock_offset_s: float | None = ..., name: str = ...) -> CameraCalibration: ...
    @property
    def intrinsics(self) -> CameraIntrinsics:
        """The CameraIntrinsics."""
    @property
    def body_from_camera(self) -> RigidTransform | None:
        """The mount, a RigidTransform from the camera frame to the body's (FLU: x forward, y left, z up);
        None: not known.
        """
    @property
    def clock_offset_s(self) -> float | None:
        """t_nav = t_image + clock_offset_s, s; None: not known."""
    @property
    def name(self) -> str:
        """Name of the camera in its file."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class CameraModel:
    """A calibrated lens: points in the camera frame (x right, y down, z along the optical axis) to
    pixels, and pixels to rays, past 90 degrees from the axis. Immutable.
    """
    @property
    def max_angle(self) -> float:
        """Largest angle (rad) between a ray and the optical axis that the lens model covers."""
    @property
    def intrinsics(self) -> CameraIntrinsics:
        """The CameraIntrinsics."""
    def __init__(self, camera: CameraModel | CameraIntrinsics | CameraCalibration) -> None:
        """camera: CameraIntrinsics or CameraCalibration. Raises InputError that names all that is wrong
        with it.
        """
    def project(self, points_in_camera: ArrayLike) -> NDArray[np.float64]:
        """Projects points.

        points_in_camera: N x 3 (or 3), of any length.
        Returns pixels, float64 N x 2 (or 2), also outside of the image; NaN where the lens model does
        not cover the point.
        """
    def unproject(self, pixels: ArrayLike) -> NDArray[np.float64]:
        """Returns the unit rays through pixels, float64 N x 3 (or 3): the exact inverse of project. NaN
        where the lens model does not cover the pixel.

        pixels: N x 2 (or 2).
        """

class RayTable:
    """Rays of pixels by a precomputed table, some 10 ns a pixel. Within 0.01 px of
    CameraModel.unproject inside of the image. Immutable.
    """
    def __init__(self, camera: CameraModel | CameraIntrinsics | CameraCalibration) -> None:
        """camera: CameraModel, CameraIntrinsics or CameraCalibration."""
    def rays(self, pixels: ArrayLike) -> NDArray[np.float32]:
        """Returns the unit rays through pixels, float32 N x 3 (or 3), in the camera frame; zeros outside
        of the lens model and of the table.

        pixels: N x 2 (or 2); a float32 array in order is read without a copy.
        """

class TargetTag:
    """A tag of a pad."""
    def __init__(self, *, family: str = ..., id: int = ..., size_m: float = ..., pattern_from_tag: RigidTransform = ...) -> None: ...
    def replace(self, *, family: str = ..., id: int = ..., size_m: float = ..., pattern_from_tag: RigidTransform = ...) -> TargetTag: ...
    @property
    def family(self) -> str:
        """Name of its family, as 'tag36h11'."""
    @property
    def id(self) -> int:
        """int."""
    @property
    def size_m(self) -> float:
        """Side where its black and white borders meet, m."""
    @property
    def pattern_from_tag(self) -> RigidTransform:
        """RigidTransform from the tag's frame (x right, y up) to the pad's."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class TargetShape:
    """What a pad looks like. Its frame: origin in the middle of what is detected, z up out of the
    printed face.
    """
    def __init__(self, *, diameter_m: float = ..., board_size_m: float = ..., outlines: list[list[ArrayLike]] = ..., tags: list[TargetTag] = ...) -> None: ...
    def replace(self, *, diameter_m: float = ..., board_size_m: float = ..., outlines: list[list[ArrayLike]] = ..., tags: list[TargetTag] = ...) -> TargetShape: ...
    @property
    def diameter_m(self) -> float:
        """Of the circle around all that is detected, m."""
    @property
    def board_size_m(self) -> float:
        """Side of the square board, m."""
    @property
    def outlines(self) -> list[list[NDArray[np.float64]]]:
        """Edges of the print, a list of lines of points, m, in the pad's frame."""
    @property
    def tags(self) -> list[TargetTag]:
        """List of TargetTag."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class PadView:
    """Camera and shape of a pad that was seen, for drawing it."""
    @property
    def camera(self) -> CameraModel:
        """CameraModel."""
    @property
    def shape(self) -> TargetShape:
        """TargetShape."""

class TargetHint:
    """What is known about a frame before it is searched. Everything may be None; it may be wrong, and
    a pad in plain view is found all the same.
    """
    def __init__(self, *, center_in_camera: ArrayLike | None = ..., center_sigma_m: float = ..., rotation_in_camera: ArrayLike | None = ..., id: int | None = ..., altitude_m: float | None = ..., up_in_camera: ArrayLike | None = ..., first_step: int = ..., max_search_ms: float = ...) -> None: ...
    def replace(self, *, center_in_camera: ArrayLike | None = ..., center_sigma_m: float = ..., rotation_in_camera: ArrayLike | None = ..., id: int | None = ..., altitude_m: float | None = ..., up_in_camera: ArrayLike | None = ..., first_step: int = ..., max_search_ms: float = ...) -> TargetHint: ...
    @property
    def center_in_camera(self) -> NDArray[np.float64] | None:
        """Expected centre of the pad, camera frame, float64 of 3, m."""
    @property
    def center_sigma_m(self) -> float:
        """Its standard deviation per axis, m."""
    @property
    def rotation_in_camera(self) -> NDArray[np.float64] | None:
        """Expected orientation camera_from_target, quaternion w, x, y, z."""
    @property
    def id(self) -> int | None:
        """Which pad it is."""
    @property
    def altitude_m(self) -> float | None:
        """Height of the camera above the pad, m."""
    @property
    def up_in_camera(self) -> NDArray[np.float64] | None:
        """Unit vector away from the ground, camera frame."""
    @property
    def first_step(self) -> int:
        """SearchDiagnostics.next_step of the frame before."""
    @property
    def max_search_ms(self) -> float:
        """Time limit, ms; 0: none."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class SeenPrint:
    """Where the image shows a print, whatever lens and sheet are."""
    def __init__(self, *, near_pose: RigidTransform = ..., displacement_px: ArrayLike = ..., radius_m: float = ...) -> None: ...
    def replace(self, *, near_pose: RigidTransform = ..., displacement_px: ArrayLike = ..., radius_m: float = ...) -> SeenPrint: ...
    @property
    def near_pose(self) -> RigidTransform:
        """RigidTransform."""
    @property
    def displacement_px(self) -> NDArray[np.float64]:
        """float64 2 x 8, px."""
    @property
    def radius_m(self) -> float:
        """Unit of length of the displacement, m."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class CalibrationEvidence:
    """What one view of a print says about the camera's calibration."""
    def __init__(self, *, log_focal: float = ..., log_focal_sigma: float = ..., principal_px: ArrayLike = ..., surprise: float = ..., contradicts: bool = ..., information: ArrayLike = ..., pull: ArrayLike = ..., edge_variance: float = ...) -> None: ...
    def replace(self, *, log_focal: float = ..., log_focal_sigma: float = ..., principal_px: ArrayLike = ..., surprise: float = ..., contradicts: bool = ..., information: ArrayLike = ..., pull: ArrayLike = ..., edge_variance: float = ...) -> CalibrationEvidence: ...
    @property
    def log_focal(self) -> float:
        """Logarithm of true over calibrated focal length."""
    @property
    def log_focal_sigma(self) -> float:
        """Its standard deviation."""
    @property
    def principal_px(self) -> NDArray[np.float64]:
        """Error of the principal point, px."""
    @property
    def surprise(self) -> float:
        """Squared Mahalanobis distance of both from the calibration; 3 on average."""
    @property
    def contradicts(self) -> bool:
        """True when the calibration cannot explain the view."""
    @property
    def information(self) -> NDArray[np.float64]:
        """float64 4 x 4, of the edges alone."""
    @property
    def pull(self) -> NDArray[np.float64]:
        """float64 of 4."""
    @property
    def edge_variance(self) -> float:
        """px^2."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class SeenPart:
    """A part of a pad that was recognised."""
    def __init__(self, *, name: str = ..., tag: int | None = ..., size_px: float = ...) -> None: ...
    def replace(self, *, name: str = ..., tag: int | None = ..., size_px: float = ...) -> SeenPart: ...
    @property
    def name(self) -> str:
        """'ring', 'tag', ..."""
    @property
    def tag(self) -> int | None:
        """Index in TargetShape.tags, or None."""
    @property
    def size_px(self) -> float:
        """Its longer side or axis, px."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class DetectionDiagnostics:
    """How a detection fits lens and print, for the examination of a calibration."""
    def __init__(self, *, misfit_px: float = ..., misfit_bound_px: float = ..., seen: SeenPrint | None = ..., calibration: CalibrationEvidence = ..., mirror_camera_from_target: RigidTransform | None = ...) -> None: ...
    def replace(self, *, misfit_px: float = ..., misfit_bound_px: float = ..., seen: SeenPrint | None = ..., calibration: CalibrationEvidence = ..., mirror_camera_from_target: RigidTransform | None = ...) -> DetectionDiagnostics: ...
    @property
    def misfit_px(self) -> float:
        """Distance of the edges from where pose and lens predict them, RMS, px."""
    @property
    def misfit_bound_px(self) -> float:
        """Largest misfit that agrees with print and lens, px."""
    @property
    def seen(self) -> SeenPrint | None:
        """SeenPrint or None."""
    @property
    def calibration(self) -> CalibrationEvidence:
        """CalibrationEvidence."""
    @property
    def mirror_camera_from_target(self) -> RigidTransform | None:
        """The other pose under which the print looks the same, or None."""
    @property
    def is_misfit(self) -> bool:
        """True when lens or print are not as described."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class TargetDetection:
    """A pad in an image."""
    def __init__(self, *, center_px: ArrayLike = ..., camera_from_target: RigidTransform = ..., covariance: ArrayLike = ..., method: DetectionMethod | str = ..., quality: float = ..., semi_major_px: float = ..., semi_minor_px: float = ..., id: int | None = ..., heading_symmetry: int = ..., parts: list[SeenPart] = ..., diagnostics: DetectionDiagnostics = ...) -> None: ...
    def replace(self, *, center_px: ArrayLike = ..., camera_from_target: RigidTransform = ..., covariance: ArrayLike = ..., method: DetectionMethod | str = ..., quality: float = ..., semi_major_px: float = ..., semi_minor_px: float = ..., id: int | None = ..., heading_symmetry: int = ..., parts: list[SeenPart] = ..., diagnostics: DetectionDiagnostics = ...) -> TargetDetection: ...
    @property
    def center_px(self) -> NDArray[np.float64]:
        """Its centre, float64 of 2, px."""
    @property
    def camera_from_target(self) -> RigidTransform:
        """RigidTransform from the pad's frame to the camera's (x right, y down, z forward), m."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """Of the pose's error, float64 6 x 6: translation in the camera frame (m^2), rotation vector in
        the camera frame (rad^2).
        """
    @property
    def method(self) -> DetectionMethod:
        """DetectionMethod."""
    @property
    def quality(self) -> float:
        """Probability that it is the pad, 0 to 1."""
    @property
    def semi_major_px(self) -> float:
        """Half of its longest extent, px."""
    @property
    def semi_minor_px(self) -> float:
        """Half of its extent across, px."""
    @property
    def id(self) -> int | None:
        """Which pad it is, where pads of this kind differ; or None."""
    @property
    def heading_symmetry(self) -> int:
        """Number of headings under which the pad looks the same; 0: all."""
    @property
    def parts(self) -> list[SeenPart]:
        """List of SeenPart."""
    @property
    def diagnostics(self) -> DetectionDiagnostics:
        """DetectionDiagnostics."""
    @property
    def center_in_camera(self) -> NDArray[np.float64]:
        """Its centre in the camera frame, float64 of 3, m."""
    @property
    def sigma_in_camera(self) -> NDArray[np.float64]:
        """Standard deviations of that, m."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class SearchDiagnostics:
    """Counts and times of one search for a pad."""
    def __init__(self, *, candidates: dict[str, int] = ..., stage_ns: dict[str, int] = ..., next_step: int = ...) -> None: ...
    def replace(self, *, candidates: dict[str, int] = ..., stage_ns: dict[str, int] = ..., next_step: int = ...) -> SearchDiagnostics: ...
    @property
    def candidates(self) -> dict[str, int]:
        """Number of candidates that entered each stage, by the stages' names."""
    @property
    def stage_ns(self) -> dict[str, int]:
        """Time in each stage, ns, by the stages' names."""
    @property
    def next_step(self) -> int:
        """Step at which the search ran out of time; 0: it did not."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class TargetReport:
    """The result of a search for a pad: the detection, or why there is none."""
    def __init__(self, *, detection: TargetDetection | None = ..., reached: LandingStage | str = ..., reason: str = ..., diagnostics: SearchDiagnostics = ..., view: PadView = ...) -> None: ...
    def replace(self, *, detection: TargetDetection | None = ..., reached: LandingStage | str = ..., reason: str = ..., diagnostics: SearchDiagnostics = ..., view: PadView = ...) -> TargetReport: ...
    @property
    def detection(self) -> TargetDetection | None:
        """TargetDetection or None."""
    @property
    def reached(self) -> LandingStage:
        """LandingStage: FOUND, or the stage at which the best candidate fell."""
    @property
    def reason(self) -> str:
        """Why it fell; empty when found."""
    @property
    def diagnostics(self) -> SearchDiagnostics:
        """SearchDiagnostics."""
    @property
    def view(self) -> PadView:
        """PadView for drawing it, or None."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""
    def __bool__(self) -> bool: ...

class TargetDetector:
    """Finds one kind of pad in gray images of one camera. Any number of threads may use one at the
    same time.
    """
    @property
    def camera(self) -> CameraModel:
        """The CameraModel."""
    @property
    def shape(self) -> TargetShape:
        """The TargetShape."""
    def detect(self, image: NDArray[np.uint8], hint: TargetHint = ...) -> TargetReport:
        """Searches an image.

        image: uint8 of shape (rows, columns), of the camera's size, gray; its pixels are not copied.
        Rows may be apart, as in a part of an array.
        hint: TargetHint, what is known before.
        Returns a TargetReport. Raises TypeError for another kind of array, InputError for another size.
        Lets other threads run.
        """

class LandingPatternDetector(TargetDetector):
    """Finds the landing pattern: a black ring with a cross on a white board."""
    def __init__(self, camera: CameraModel | CameraIntrinsics | CameraCalibration, options: _Options = ..., **kwargs: Any) -> None:
        """camera: CameraModel, CameraCalibration or CameraIntrinsics.
        options: a dict by the names of `kestrel config` under landing.detector, or the path of such a
        file; keyword arguments are options, too, as pattern={'outer_diameter_m': 0.6}, min_quality=0.9.
        """

class TagBoardDetector(TargetDetector):
    """Finds a board of AprilTags and ArUco markers, or a single one."""
    def __init__(self, camera: CameraModel | CameraIntrinsics | CameraCalibration, board: _Path | Sequence[Mapping[str, Any]], **kwargs: Any) -> None:
        """board: a list of dicts, as [{'family': 'tag36h11', 'id': 3, 'size_m': 0.5}] (x_m, y_m and
        yaw_deg place a tag on the board), or the path of its YAML file.
        Keyword arguments: landing.target.tags of `kestrel config`.
        """

class RingWithTagsDetector(TargetDetector):
    """Finds the landing pattern whose board also has tags."""
    def __init__(self, camera: CameraModel | CameraIntrinsics | CameraCalibration, board: _Path | Sequence[Mapping[str, Any]], ring: Mapping[str, Any] = ..., tags: Mapping[str, Any] = ...) -> None:
        """board: the tags, in the ring's frame, as of TagBoardDetector.
        ring, tags: dicts of landing.detector and landing.target.tags of `kestrel config`.
        """

class TagDetection:
    """A tag in an image."""
    def __init__(self, *, family: str = ..., id: int = ..., corners_px: ArrayLike = ..., decision_margin: float = ...) -> None: ...
    def replace(self, *, family: str = ..., id: int = ..., corners_px: ArrayLike = ..., decision_margin: float = ...) -> TagDetection: ...
    @property
    def family(self) -> str:
        """Name of its family, as 'tag36h11'."""
    @property
    def id(self) -> int:
        """int."""
    @property
    def corners_px(self) -> NDArray[np.float64]:
        """Corners of the square where its black and white borders meet, float64 4 x 2, px: clockwise in
        the image from the tag's upper left corner, as OpenCV's detectMarkers returns them; libapriltag
        has them in reverse.
        """
    @property
    def decision_margin(self) -> float:
        """Mean distance of the bits from the threshold between black and white, gray values, as
        libapriltag defines it, but without its sharpening.
        """
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class HelipadDetector(TargetDetector):
    """Finds a helipad by its H."""
    def __init__(self, camera: CameraModel | CameraIntrinsics | CameraCalibration, options: _Options = ..., **kwargs: Any) -> None:
        """options: landing.target.helipad of `kestrel config`, as of LandingPatternDetector."""

class OwnPadDetector(TargetDetector):
    """A pad of your own, found by a function, as a pipeline takes it."""
    def __init__(self, camera: CameraModel | CameraIntrinsics | CameraCalibration, shape: TargetShape, find: Callable[[NDArray[np.uint8], TargetHint], TargetDetection | None]) -> None:
        """shape: TargetShape, for pictures and the track.
        find: function of an image (uint8, rows x columns) and a TargetHint that returns a
        TargetDetection, or None. What it raises is the reason in the report.
        """

class ObjectModel:
    """The colours and the classes of the objects to find."""
    @property
    def class_names(self) -> list[str]:
        """Names of the classes, by their index."""
    @property
    def color_names(self) -> list[str]:
        """Names of the colours, by their index."""
    def __init__(self, file: _Path | None = ...) -> None:
        """file: path of a model (YAML); None: the objects of MBZIRC 2017."""
    @staticmethod
    def from_yaml(text: str) -> ObjectModel:
        """Returns the model of a YAML text. Raises InputError with the line."""
    def to_yaml(self) -> str:
        """Returns the YAML text of the same model."""

class Ellipse:
    """An ellipse in the image."""
    def __init__(self, *, center: ArrayLike = ..., semi_major: float = ..., semi_minor: float = ..., angle: float = ...) -> None: ...
    def replace(self, *, center: ArrayLike = ..., semi_major: float = ..., semi_minor: float = ..., angle: float = ...) -> Ellipse: ...
    @property
    def center(self) -> NDArray[np.float64]:
        """float64 of 2, px."""
    @property
    def semi_major(self) -> float:
        """px."""
    @property
    def semi_minor(self) -> float:
        """px."""
    @property
    def angle(self) -> float:
        """Of the major axis, rad from x to y."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class ObjectLocation:
    """Where an object is."""
    def __init__(self, *, position: ArrayLike = ..., covariance: ArrayLike = ...) -> None: ...
    def replace(self, *, position: ArrayLike = ..., covariance: ArrayLike = ...) -> ObjectLocation: ...
    @property
    def position(self) -> NDArray[np.float64]:
        """float64 of 3, m."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """float64 3 x 3, m^2."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class HeightBySize:
    """Height of the camera above the ground, from an object's size alone."""
    def __init__(self, *, camera_height_m: float = ..., sigma_m: float = ...) -> None: ...
    def replace(self, *, camera_height_m: float = ..., sigma_m: float = ...) -> HeightBySize: ...
    @property
    def camera_height_m(self) -> float:
        """m."""
    @property
    def sigma_m(self) -> float:
        """Standard deviation, m."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class Hsv:
    """A colour."""
    def __init__(self, *, hue_deg: float = ..., saturation: float = ..., value: float = ...) -> None: ...
    def replace(self, *, hue_deg: float = ..., saturation: float = ..., value: float = ...) -> Hsv: ...
    @property
    def hue_deg(self) -> float:
        """0 to 360."""
    @property
    def saturation(self) -> float:
        """0 to 1."""
    @property
    def value(self) -> float:
        """0 to 1."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class ObjectDetection:
    """A coloured object in an image."""
    def __init__(self, *, class_index: int = ..., completeness: Completeness | str = ..., center_px: ArrayLike = ..., bearing: ArrayLike = ..., ellipse: Ellipse = ..., roundness: float = ..., circularity: float = ..., pixels: int = ..., misfit: float = ..., mean_color: Hsv = ..., color_probabilities: list[float] = ..., class_probability: float = ..., digits: list[float] | None = ..., location: ObjectLocation | None = ..., height: HeightBySize | None = ...) -> None: ...
    def replace(self, *, class_index: int = ..., completeness: Completeness | str = ..., center_px: ArrayLike = ..., bearing: ArrayLike = ..., ellipse: Ellipse = ..., roundness: float = ..., circularity: float = ..., pixels: int = ..., misfit: float = ..., mean_color: Hsv = ..., color_probabilities: list[float] = ..., class_probability: float = ..., digits: list[float] | None = ..., location: ObjectLocation | None = ..., height: HeightBySize | None = ...) -> ObjectDetection: ...
    @property
    def class_index(self) -> int:
        """Index in ObjectModel.class_names."""
    @property
    def completeness(self) -> Completeness:
        """'whole', 'cut off' or 'merged'."""
    @property
    def center_px(self) -> NDArray[np.float64]:
        """float64 of 2, px."""
    @property
    def bearing(self) -> NDArray[np.float64]:
        """Unit ray through it, camera frame."""
    @property
    def ellipse(self) -> Ellipse:
        """Ellipse of its pixels' moments."""
    @property
    def roundness(self) -> float:
        """1 for a disc seen from above."""
    @property
    def circularity(self) -> float:
        """1 for a disc."""
    @property
    def pixels(self) -> int:
        """Number of its pixels."""
    @property
    def misfit(self) -> float:
        """0 is perfect; most objects have less than 0.5."""
    @property
    def mean_color(self) -> Hsv:
        """Hsv."""
    @property
    def color_probabilities(self) -> list[float]:
        """Probability of each of the model's colours."""
    @property
    def class_probability(self) -> float:
        """Of its class, 0 to 1."""
    @property
    def digits(self) -> list[float] | None:
        """Probability of each digit, of cuboids; or None."""
    @property
    def location(self) -> ObjectLocation | None:
        """ObjectLocation in the camera frame, or None."""
    @property
    def height(self) -> HeightBySize | None:
        """HeightBySize or None."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class ObjectReport:
    """All coloured objects of an image."""
    def __init__(self, *, detections: list[ObjectDetection] = ..., elsewhere: list[ObjectDetection] = ..., passed: list[int] = ..., segmentation_time_s: float = ..., test_time_s: float = ..., model: ObjectModel = ...) -> None: ...
    def replace(self, *, detections: list[ObjectDetection] = ..., elsewhere: list[ObjectDetection] = ..., passed: list[int] = ..., segmentation_time_s: float = ..., test_time_s: float = ..., model: ObjectModel = ...) -> ObjectReport: ...
    @property
    def detections(self) -> list[ObjectDetection]:
        """List of ObjectDetection."""
    @property
    def elsewhere(self) -> list[ObjectDetection]:
        """List of those that, by their size, are not on the ground as the hint has it."""
    @property
    def passed(self) -> list[int]:
        """Number of segments that passed each stage."""
    @property
    def segmentation_time_s(self) -> float:
        """s."""
    @property
    def test_time_s(self) -> float:
        """s."""
    @property
    def model(self) -> ObjectModel:
        """The ObjectModel that they are of."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class ObjectDetector:
    """Finds coloured objects in images of one camera that looks down. Any number of threads may use
    one at the same time.
    """
    @property
    def camera(self) -> CameraModel:
        """The CameraModel."""
    def __init__(self, camera: CameraModel | CameraIntrinsics | CameraCalibration, model: ObjectModel | None = ..., options: _Options = ..., **kwargs: Any) -> None:
        """model: ObjectModel; None: that of MBZIRC 2017.
        options: a dict by the names of `kestrel config` under hunt.detector, or the path of such a
        file; keyword arguments are options, too.
        """
    def detect(self, image: NDArray[np.uint8], up_in_camera: NDArray[np.float64] | None = ..., camera_height_m: float | None = ...) -> ObjectReport:
        """Searches an image.

        image: uint8 of shape (rows, columns, 3), BGR, of the camera's size; its pixels are not copied.
        up_in_camera: unit vector away from the ground, camera frame; camera_height_m: above the ground,
        m; both or none.
        Returns an ObjectReport. Lets other threads run.
        """

class TargetMeasurement:
    """A measured position of the target at the time of an image."""
    def __init__(self, *, time_ns: int = ..., position_in_world: ArrayLike = ..., covariance: ArrayLike = ..., shared_covariance: ArrayLike = ..., yaw: float | None = ..., yaw_variance: float = ..., yaw_period: float = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., position_in_world: ArrayLike = ..., covariance: ArrayLike = ..., shared_covariance: ArrayLike = ..., yaw: float | None = ..., yaw_variance: float = ..., yaw_period: float = ...) -> TargetMeasurement: ...
    @property
    def time_ns(self) -> int:
        """int, ns."""
    @property
    def position_in_world(self) -> NDArray[np.float64]:
        """float64 of 3, ENU, m."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """Of this position alone, float64 3 x 3, m^2."""
    @property
    def shared_covariance(self) -> NDArray[np.float64]:
        """Of the error that all measurements share, float64 3 x 3, m^2."""
    @property
    def yaw(self) -> float | None:
        """Yaw of the target, rad, or None."""
    @property
    def yaw_variance(self) -> float:
        """rad^2."""
    @property
    def yaw_period(self) -> float:
        """Turn (rad) after which the target looks the same."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class TurnState:
    """State of the motion: position and velocity (3 each), turn rate and its derivative, sway's part
    of position and velocity (2 each), yaw.
    """
    def __init__(self, *, mean: ArrayLike = ..., covariance: ArrayLike = ...) -> None: ...
    def replace(self, *, mean: ArrayLike = ..., covariance: ArrayLike = ...) -> TurnState: ...
    @property
    def mean(self) -> NDArray[np.float64]:
        """float64 of 13."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """float64 13 x 13."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class TargetEstimate:
    """The target at one time, in the world (ENU)."""
    def __init__(self, *, time_ns: int = ..., motion: TurnState = ..., yaw_period: float = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., motion: TurnState = ..., yaw_period: float = ...) -> TargetEstimate: ...
    @property
    def time_ns(self) -> int:
        """int, ns."""
    @property
    def motion(self) -> TurnState:
        """TurnState."""
    @property
    def yaw_period(self) -> float:
        """Turn (rad) modulo which `yaw` is its heading; 0: no yaw was measured."""
    @property
    def position(self) -> NDArray[np.float64]:
        """float64 of 3, m."""
    @property
    def velocity(self) -> NDArray[np.float64]:
        """float64 of 3, m/s."""
    @property
    def yaw(self) -> float:
        """rad."""
    @property
    def turn_rate(self) -> float:
        """rad/s."""
    @property
    def speed(self) -> float:
        """Horizontal, m/s."""
    @property
    def heading(self) -> float:
        """Of the velocity, rad from east to north."""
    @property
    def position_sigma_m(self) -> float:
        """Standard deviation per axis, m."""
    @property
    def velocity_sigma_mps(self) -> float:
        """Standard deviation per axis, m/s."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class TargetTracker:
    """Tracks one ground vehicle: measured positions in, late ones too; its motion now and in the near
    future out.
    """
    def __init__(self, options: _Options = ..., **kwargs: Any) -> None:
        """options: a dict by the names of `kestrel config` under landing.tracker, or the path of such a
        file; keyword arguments are options, too.
        """
    def add(self, measurement: TargetMeasurement) -> MeasurementFate:
        """Adds a TargetMeasurement. Returns what became of it: 'started', 'accepted', 'invalid', 'too
        old', 'far from the track'.
        """
    def state_at(self, time_ns: int) -> TrackState:
        """Returns 'searching', 'tracking', 'predicting' or 'lost'."""
    def predict(self, time_ns: int) -> TargetEstimate | None:
        """Returns the TargetEstimate of a time, predicted after the newest measurement; None before the
        oldest one and when the target is lost.
        """

class RegionState(str, enum.Enum):
    """Whether a region is seen in the image, was seen within the last 0.5 s, or is lost and looked
    for.
    """
    FOLLOWING = "following"
    COASTING = "coasting"
    LOST = "lost"

class RegionReport:
    """A region in an image."""
    @property
    def state(self) -> RegionState:
        """RegionState."""
    @property
    def box_px(self) -> list[float]:
        """x, y, width, height, px: the pixel (x, y) is the upper left one. The last place when the region
        is lost.
        """
    @property
    def probability(self) -> float:
        """That the box is on what was marked, 0 to 1."""

class RegionTracker:
    """Follows a region of an image that a person has marked, by its appearance: whatever it shows.

        tracker = kestrel.RegionTracker()
        tracker.mark(first, 0, (310, 200, 40, 60))
        for i, image in enumerate(images):
            report = tracker.track(image, i * 33_000_000)
            print(report.state, report.box_px)
    """
    def __init__(self) -> None:
        """Makes a tracker that follows nothing yet."""
    def mark(self, image: NDArray[np.uint8], time_ns: int, box_px: list[float]) -> None:
        """Starts on a region of an image, in place of any before. image: uint8, gray or BGR. box_px: x, y,
        width, height, at least 4 px wide and high. Raises InputError for a box that is not in the
        image.
        """
    def track(self, image: NDArray[np.uint8], time_ns: int, expected_px: NDArray[np.float64] | None = ..., sigma_px: float = ...) -> RegionReport:
        """Returns a RegionReport of a later image of the same size and type. expected_px: where its middle
        is expected (2), or None; sigma_px: standard deviation of that, for a lost region.
        """

class MappedObject:
    """What a map knows of an object."""
    def __init__(self, *, id: int = ..., shape: ObjectShape | str = ..., first_seen_ns: int = ..., last_seen_ns: int = ..., time_ns: int = ..., state: ArrayLike = ..., covariance: ArrayLike = ..., may_move: bool = ..., move_log_odds: float = ..., moves: bool = ..., detections: int = ..., log_odds: float = ..., color: Hsv = ..., color_log_likelihoods: list[float] = ..., digit_log_likelihoods: list[float] = ...) -> None: ...
    def replace(self, *, id: int = ..., shape: ObjectShape | str = ..., first_seen_ns: int = ..., last_seen_ns: int = ..., time_ns: int = ..., state: ArrayLike = ..., covariance: ArrayLike = ..., may_move: bool = ..., move_log_odds: float = ..., moves: bool = ..., detections: int = ..., log_odds: float = ..., color: Hsv = ..., color_log_likelihoods: list[float] = ..., digit_log_likelihoods: list[float] = ...) -> MappedObject: ...
    @property
    def id(self) -> int:
        """Unique within its map."""
    @property
    def shape(self) -> ObjectShape:
        """'disc', 'cuboid' or 'bar'."""
    @property
    def first_seen_ns(self) -> int:
        """int, ns."""
    @property
    def last_seen_ns(self) -> int:
        """int, ns."""
    @property
    def time_ns(self) -> int:
        """Of the state, int, ns."""
    @property
    def state(self) -> NDArray[np.float64]:
        """Position (m), velocity (m/s), acceleration (m/s^2) in the world (ENU), float64 of 9."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """float64 9 x 9."""
    @property
    def may_move(self) -> bool:
        """By its class."""
    @property
    def move_log_odds(self) -> float:
        """Log odds that it moves."""
    @property
    def moves(self) -> bool:
        """True once that is beyond doubt."""
    @property
    def detections(self) -> int:
        """Number of its detections."""
    @property
    def log_odds(self) -> float:
        """Log odds that it exists."""
    @property
    def color(self) -> Hsv:
        """Hsv of the last detection."""
    @property
    def color_log_likelihoods(self) -> list[float]:
        """Of the model's colours."""
    @property
    def digit_log_likelihoods(self) -> list[float]:
        """Of the digits."""
    @property
    def position(self) -> NDArray[np.float64]:
        """float64 of 3, m, ENU."""
    @property
    def velocity(self) -> NDArray[np.float64]:
        """float64 of 3, m/s, ENU."""
    @property
    def sigma_m(self) -> float:
        """Standard deviation of the position per axis, m."""
    @property
    def color_index(self) -> int:
        """Index in ObjectModel.color_names."""
    @property
    def digit(self) -> int | None:
        """The likeliest digit of a cuboid, or None."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class ObjectMeasurement:
    """A detection with its place in the world."""
    def __init__(self, *, delay_s: float = ..., position: ArrayLike = ..., covariance: ArrayLike = ..., clock_shift: ArrayLike = ..., shape: ObjectShape | str = ..., color: Hsv = ..., color_probabilities: list[float] = ..., digits: list[float] | None = ...) -> None: ...
    def replace(self, *, delay_s: float = ..., position: ArrayLike = ..., covariance: ArrayLike = ..., clock_shift: ArrayLike = ..., shape: ObjectShape | str = ..., color: Hsv = ..., color_probabilities: list[float] = ..., digits: list[float] | None = ...) -> ObjectMeasurement: ...
    @property
    def delay_s(self) -> float:
        """Relative to the frame's time, s."""
    @property
    def position(self) -> NDArray[np.float64]:
        """float64 of 3, m, ENU."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """float64 3 x 3, m^2."""
    @property
    def clock_shift(self) -> NDArray[np.float64]:
        """Error of the position per error of the clock offset, float64 of 3, m/s."""
    @property
    def shape(self) -> ObjectShape:
        """'disc', 'cuboid' or 'bar'."""
    @property
    def color(self) -> Hsv:
        """Hsv."""
    @property
    def color_probabilities(self) -> list[float]:
        """Of the model's colours."""
    @property
    def digits(self) -> list[float] | None:
        """Probability of each digit, or None."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class ObjectMap:
    """The map of objects: detections in the world in, confirmed objects out, each counted once."""
    def __init__(self, model: ObjectModel | None = ..., options: _Options = ..., **kwargs: Any) -> None:
        """model: ObjectModel; None: that of MBZIRC 2017.
        options: a dict by the names of `kestrel config` under hunt.map, or the path of such a file;
        keyword arguments are options, too.
        """
    def update(self, time_ns: int, measurements: list[ObjectMeasurement], shows: Callable[[MappedObject], bool] | None = ...) -> None:
        """Adds the detections of one frame, a list of ObjectMeasurement. An older frame is ignored.

        shows: function that says of a MappedObject whether it should have been seen; None: all should.
        """
    def confirmed(self) -> list[MappedObject]:
        """Returns the objects that were seen often enough, a list of MappedObject."""
    def objects(self) -> list[MappedObject]:
        """Returns all objects."""

class LandingObservation:
    """What the landing pipeline saw in a frame."""
    def __init__(self, *, time_ns: int = ..., camera: int = ..., report: TargetReport = ..., world_from_camera: RigidTransform | None = ..., pose: PoseLookup | str = ..., pose_uncertainty: PoseUncertainty = ..., center_in_world: ArrayLike | None = ..., position_method: PositionMethod | str = ..., yaw_in_world: float | None = ..., fate: MeasurementFate | str | None = ..., track_state: TrackState | str = ..., target: TargetEstimate | None = ..., detect_time_s: float = ..., view: PadView = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., camera: int = ..., report: TargetReport = ..., world_from_camera: RigidTransform | None = ..., pose: PoseLookup | str = ..., pose_uncertainty: PoseUncertainty = ..., center_in_world: ArrayLike | None = ..., position_method: PositionMethod | str = ..., yaw_in_world: float | None = ..., fate: MeasurementFate | str | None = ..., track_state: TrackState | str = ..., target: TargetEstimate | None = ..., detect_time_s: float = ..., view: PadView = ...) -> LandingObservation: ...
    @property
    def time_ns(self) -> int:
        """Of the frame, on the images' clock; of several cameras, the first one's, int, ns."""
    @property
    def camera(self) -> int:
        """Index of the camera, int."""
    @property
    def report(self) -> TargetReport:
        """TargetReport: the detection in the camera frame, or why there is none."""
    @property
    def world_from_camera(self) -> RigidTransform | None:
        """RigidTransform, or None without a pose."""
    @property
    def pose(self) -> PoseLookup:
        """'found', 'predicted', or why there is no pose."""
    @property
    def pose_uncertainty(self) -> PoseUncertainty:
        """PoseUncertainty of a predicted pose."""
    @property
    def center_in_world(self) -> NDArray[np.float64] | None:
        """The pad's centre in the world, float64 of 3, ENU, m; or None."""
    @property
    def position_method(self) -> PositionMethod:
        """'size' or 'altitude'."""
    @property
    def yaw_in_world(self) -> float | None:
        """Yaw of the pad, rad, or None."""
    @property
    def fate(self) -> MeasurementFate | None:
        """What the track made of the detection, or None."""
    @property
    def track_state(self) -> TrackState:
        """'searching', 'tracking', 'predicting' or 'lost'."""
    @property
    def target(self) -> TargetEstimate | None:
        """TargetEstimate at the time of the frame, or None."""
    @property
    def detect_time_s(self) -> float:
        """Time of the detection alone, s."""
    @property
    def view(self) -> PadView:
        """What it is drawn by, or None."""
    @property
    def detection(self) -> TargetDetection | None:
        """That of the report."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""
    def __bool__(self) -> bool: ...

class HuntObservation:
    """What the hunt pipeline saw in a frame."""
    def __init__(self, *, time_ns: int = ..., report: ObjectReport = ..., world_from_camera: RigidTransform | None = ..., in_world: list[ObjectLocation] | None = ..., detect_time_s: float = ..., model: ObjectModel = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., report: ObjectReport = ..., world_from_camera: RigidTransform | None = ..., in_world: list[ObjectLocation] | None = ..., detect_time_s: float = ..., model: ObjectModel = ...) -> HuntObservation: ...
    @property
    def time_ns(self) -> int:
        """Of the frame, on the images' clock, int, ns."""
    @property
    def report(self) -> ObjectReport:
        """ObjectReport."""
    @property
    def world_from_camera(self) -> RigidTransform | None:
        """RigidTransform, or None without a pose."""
    @property
    def in_world(self) -> list[ObjectLocation] | None:
        """For each detection, in order: ObjectLocation in the world (ENU), or None."""
    @property
    def detect_time_s(self) -> float:
        """Time of the detection alone, s."""
    @property
    def model(self) -> ObjectModel:
        """The ObjectModel."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class PlaceOnGround:
    """A place on the ground, in the world (ENU)."""
    def __init__(self, *, position: ArrayLike = ..., covariance: ArrayLike = ...) -> None: ...
    def replace(self, *, position: ArrayLike = ..., covariance: ArrayLike = ...) -> PlaceOnGround: ...
    @property
    def position(self) -> NDArray[np.float64]:
        """float64 of 3, m."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """float64 of (3, 3), m^2, of all errors."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class FollowObservation:
    """What was seen of a marked thing in a frame."""
    def __init__(self, *, time_ns: int = ..., region: RegionReport | None = ..., world_from_camera: RigidTransform | None = ..., bearing: ArrayLike | None = ..., place: PlaceOnGround | None = ..., fate: MeasurementFate | str | None = ..., track_state: TrackState | str = ..., target: TargetEstimate | None = ..., detect_time_s: float = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., region: RegionReport | None = ..., world_from_camera: RigidTransform | None = ..., bearing: ArrayLike | None = ..., place: PlaceOnGround | None = ..., fate: MeasurementFate | str | None = ..., track_state: TrackState | str = ..., target: TargetEstimate | None = ..., detect_time_s: float = ...) -> FollowObservation: ...
    @property
    def time_ns(self) -> int:
        """Of the frame, on the images' clock, int, ns."""
    @property
    def region(self) -> RegionReport | None:
        """RegionReport, or None before something was marked."""
    @property
    def world_from_camera(self) -> RigidTransform | None:
        """RigidTransform, or None without a pose."""
    @property
    def bearing(self) -> NDArray[np.float64] | None:
        """Direction to it in the world, float64 of 3, of length 1; or None."""
    @property
    def place(self) -> PlaceOnGround | None:
        """PlaceOnGround; None near and above the horizon."""
    @property
    def fate(self) -> MeasurementFate | None:
        """What the track made of the place, or None."""
    @property
    def track_state(self) -> TrackState:
        """'searching', 'tracking', 'predicting' or 'lost'."""
    @property
    def target(self) -> TargetEstimate | None:
        """TargetEstimate at the time of the frame, or None."""
    @property
    def detect_time_s(self) -> float:
        """Time of the tracker alone, s."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class LandingPipeline:
    """The whole vision of a landing: images and poses in; the pad, its place in the world and its
    track out.
    """
    def __init__(self, calibration: CameraCalibration | list[CameraCalibration], options: _Options = ..., detector: TargetDetector | None = ..., **kwargs: Any) -> None:
        """calibration: CameraCalibration; poses place the pad in the world where it has a mount. A list:
        several cameras, which together make one track.
        options: a dict by the names of `kestrel config` under landing, or the path of such a file;
        keyword arguments are options, too, as target={'kind': 'helipad'}.
        detector: TargetDetector in place of that of the options.
        """
    def add_pose(self, sample: PoseSample) -> PoseStatus:
        """Adds a PoseSample of the navigation, later than those before. Returns 'ok', 'out of order' or
        'invalid'.
        """
    def set_altitude(self, altitude_m: float | None) -> None:
        """Sets the height (m) of the camera above what it looks for, for frames without a pose; None: not
        known.
        """
    def process(self, image: NDArray[np.uint8], time_ns: int, *, camera_index: int = ...) -> LandingObservation:
        """Processes a frame.

        image: uint8 of shape (rows, columns), gray, of the camera's size; not copied.
        time_ns: middle of the exposure, int, ns.
        camera_index: of several cameras.
        Returns a LandingObservation. Lets other threads run.
        """
    def camera_fault(self, camera_index: int) -> str | None:
        """Returns in words why one of several cameras does not contribute to the track; None where it
        does.
        """
    def predict(self, time_ns: int) -> TargetEstimate | None:
        """Returns the TargetEstimate of the track at a time, or None where it is not known."""

class HuntPipeline:
    """The whole vision of a hunt: colour images and poses in; objects and their map out."""
    def __init__(self, calibration: CameraCalibration, model: ObjectModel | None = ..., options: _Options = ..., **kwargs: Any) -> None:
        """model: ObjectModel; None: that of MBZIRC 2017.
        options: a dict by the names of `kestrel config` under hunt, or the path of such a file; keyword
        arguments are options, too.
        """
    def add_pose(self, sample: PoseSample) -> PoseStatus:
        """Adds a PoseSample of the navigation, later than those before. Returns 'ok', 'out of order' or
        'invalid'.
        """
    def set_altitude(self, altitude_m: float | None) -> None:
        """Sets the height (m) of the camera above what it looks for, for frames without a pose; None: not
        known.
        """
    def process(self, image: NDArray[np.uint8], time_ns: int) -> HuntObservation:
        """Processes a frame.

        image: uint8 of shape (rows, columns, 3), BGR, of the camera's size; not copied.
        time_ns: middle of the exposure, int, ns.
        Returns a HuntObservation. Lets other threads run.
        """
    def confirmed(self) -> list[MappedObject]:
        """Returns the confirmed objects of the map, a list of MappedObject."""

class Frame:
    """An image of a source."""
    def __init__(self, *, name: str = ..., time_ns: int = ..., camera: int = ..., image: NDArray[np.uint8] = ...) -> None: ...
    def replace(self, *, name: str = ..., time_ns: int = ..., camera: int = ..., image: NDArray[np.uint8] = ...) -> Frame: ...
    @property
    def name(self) -> str:
        """Path of the image, as given or relative to the source."""
    @property
    def time_ns(self) -> int:
        """Middle of the exposure, int, ns."""
    @property
    def camera(self) -> int:
        """Index of the camera, int."""
    @property
    def image(self) -> NDArray[np.uint8]:
        """uint8, gray or BGR, not writable; shares the pixels."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class FrameIterator:
    """Iterates over frames."""
    def __iter__(self) -> FrameIterator: ...
    def __next__(self) -> Frame: ...

class EventIterator:
    """Iterates over frames and poses."""
    def __iter__(self) -> EventIterator: ...
    def __next__(self) -> Frame | PoseSample: ...

class Recording:
    """A recording with the calibration of its camera."""
    @property
    def calibration(self) -> CameraCalibration:
        """CameraCalibration."""
    def poses(self) -> list[PoseSample]:
        """Returns the poses of the navigation, a list of PoseSample; empty where it has none."""
    def events(self) -> EventIterator:
        """Returns an iterator over PoseSample and Frame in order of time: each frame comes after the poses
        that it needs.
        """
    def __iter__(self) -> FrameIterator: ...

class TruePattern:
    """The pattern at the time of an image."""
    def __init__(self, *, time_ns: int = ..., world_from_pattern: RigidTransform = ..., velocity_in_world: ArrayLike = ..., center_px: ArrayLike = ..., altitude_m: float = ..., visible_fraction: float = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., world_from_pattern: RigidTransform = ..., velocity_in_world: ArrayLike = ..., center_px: ArrayLike = ..., altitude_m: float = ..., visible_fraction: float = ...) -> TruePattern: ...
    @property
    def time_ns(self) -> int:
        """int, ns."""
    @property
    def world_from_pattern(self) -> RigidTransform:
        """RigidTransform, m, ENU."""
    @property
    def velocity_in_world(self) -> NDArray[np.float64]:
        """float64 of 3, m/s."""
    @property
    def center_px(self) -> NDArray[np.float64]:
        """float64 of 2, px; may be out of view."""
    @property
    def altitude_m(self) -> float:
        """Height of the camera above it, m."""
    @property
    def visible_fraction(self) -> float:
        """Part of it in view, 0 to 1."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class SimulatedFlight(Recording):
    """A simulated flight: a recording whose frames are rendered when they are asked for. The same
    scenario, settings and seed give the same bytes.
    """
    @property
    def true_patterns(self) -> list[TruePattern]:
        """List of TruePattern, one for each frame; empty for a hunt."""
    def __len__(self) -> int: ...
    def __getitem__(self, index: int) -> Frame:
        """Renders a Frame. Lets other threads run."""
    def write(self, folder: _Path, replace: bool = ...) -> bool:
        """Writes the flight as a recording (EuRoC), as `kestrel simulate` does."""

class Observation:
    """A frame and what was seen in it."""
    def __init__(self, *, frame: Frame = ..., seen: LandingObservation | HuntObservation | FollowObservation = ..., latency_s: float | None = ...) -> None: ...
    def replace(self, *, frame: Frame = ..., seen: LandingObservation | HuntObservation | FollowObservation = ..., latency_s: float | None = ...) -> Observation: ...
    @property
    def frame(self) -> Frame:
        """Frame."""
    @property
    def seen(self) -> LandingObservation | HuntObservation | FollowObservation:
        """LandingObservation, HuntObservation or FollowObservation."""
    @property
    def latency_s(self) -> float | None:
        """Time from the capture until it was processed, s; None for recordings."""
    @property
    def csv_header(self) -> str:
        """First line of object_detections.csv, landing_detections.csv or follow_track.csv."""
    @property
    def csv_rows(self) -> str:
        """Its lines of that table."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class Session:
    """A source, the vision, and functions that get the results: what `kestrel land`, `kestrel hunt`,
    `kestrel follow` and, live, `kestrel fly` run.
    """
    def __init__(self, source: _Path | Sequence[_Path] | Recording, camera: _Path | None = ..., sinks: Sequence[Callable[[Observation], Any]] = ..., *, hunt: bool = ..., options: _Options = ..., altitude_m: float | None = ..., model: ObjectModel | None = ..., output: str = ..., replace: bool = ..., live: bool = ..., autopilot: str = ..., guide: bool = ..., record: str = ..., on_event: Callable[[str], Any] | None = ..., follow: list[float] | None = ..., follow_at: str = ...) -> None:
        """source: a path (recording, bag, video, images), a Recording or SimulatedFlight; with live=True
        also '/dev/video0', 'rtsp://...', a GStreamer pipeline, 'dds:/camera/image_raw' of ROS 2 or
        'sim:standing', a simulated flight.
        camera: path of the calibration; None: the source's own.
        sinks: functions that get each Observation.
        hunt: looks for coloured objects ('model') instead of a pad.
        options: a dict by the names of `kestrel config`, as {'landing': {'target': {'kind':
        'helipad'}}}, or the path of such a file.
        altitude_m: height of the camera above what it looks for, where there are no poses.
        output: folder of the tables, as the commands write them; replace: those that are there.
        live: in real time, as it is flown; a sink that is slow misses frames.
        autopilot, guide, record: of live sessions, as of `kestrel fly`, also autopilot='sim:ardupilot'
        or 'sim:px4', a simulated one.
        on_event: gets each message, as a warning, as a text.
        follow: box (x, y, width, height, px) around what is to be followed in a recording, in the frame
        'follow_at', its number or name.
        """
    def run(self) -> str:
        """Runs to the end of the source, until stop() or Ctrl-C. Returns a summary in words. Raises
        InputError when the source fails, and what a sink raises: at once over a recording, after its
        end in a flight, which goes on without the sink.
        """
    def stop(self) -> None:
        """Ends the run after the present frame. Any thread may call it."""

class LandingVerdict(str, enum.Enum):
    """Whether a pad was found, missed, another thing was detected (FALSE), or there was neither a pad
    nor a detection (QUIET).
    """
    FOUND = "found"
    MISSED = "missed"
    FALSE = "false"
    QUIET = "quiet"

class LandingErrors:
    """Errors of a right detection, estimate minus truth."""
    def __init__(self, *, center_px: float = ..., lateral_m: float = ..., depth_m: float = ..., nees: float = ..., in_world: ArrayLike | None = ..., yaw: float | None = ...) -> None: ...
    def replace(self, *, center_px: float = ..., lateral_m: float = ..., depth_m: float = ..., nees: float = ..., in_world: ArrayLike | None = ..., yaw: float | None = ...) -> LandingErrors: ...
    @property
    def center_px(self) -> float:
        """Of the centre in the image, px."""
    @property
    def lateral_m(self) -> float:
        """Across the true line of sight, m."""
    @property
    def depth_m(self) -> float:
        """Along it, m; positive: too far away."""
    @property
    def nees(self) -> float:
        """Position in the camera against the reported variances; 3 on average is right."""
    @property
    def in_world(self) -> NDArray[np.float64] | None:
        """float64 of 3, ENU, m; None without a pose."""
    @property
    def yaw(self) -> float | None:
        """rad, to the nearest heading under which what was seen of the pad looks the same, or None."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class LandingComparison:
    """An image, its result, its truth."""
    def __init__(self, *, time_ns: int = ..., condition: str = ..., verdict: LandingVerdict | str = ..., truth: TruePattern | None = ..., tilt: float | None = ..., motion_px: float | None = ..., errors: LandingErrors | None = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., condition: str = ..., verdict: LandingVerdict | str = ..., truth: TruePattern | None = ..., tilt: float | None = ..., motion_px: float | None = ..., errors: LandingErrors | None = ...) -> LandingComparison: ...
    @property
    def time_ns(self) -> int:
        """Of the image, int, ns."""
    @property
    def condition(self) -> str:
        """Light and weather of scene.yaml."""
    @property
    def verdict(self) -> LandingVerdict:
        """LandingVerdict."""
    @property
    def truth(self) -> TruePattern | None:
        """TruePattern, or None where the pad is not in the scene."""
    @property
    def tilt(self) -> float | None:
        """Angle between the UAV's z axis and the vertical, rad, or None."""
    @property
    def motion_px(self) -> float | None:
        """Motion of the pad's centre during the exposure, px, or None."""
    @property
    def errors(self) -> LandingErrors | None:
        """LandingErrors of what was found, or None."""
    @property
    def is_visible(self) -> bool:
        """True where at least a quarter of the pad is in view."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class ObjectComparison:
    """A detection, an object in view, or a pair of both."""
    def __init__(self, *, time_ns: int = ..., true_id: int | None = ..., true_class: str = ..., is_wanted: bool = ..., detected_class: str = ..., class_probability: float = ..., center_error_px: float = ..., depth_error: float | None = ..., world_error_m: float | None = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., true_id: int | None = ..., true_class: str = ..., is_wanted: bool = ..., detected_class: str = ..., class_probability: float = ..., center_error_px: float = ..., depth_error: float | None = ..., world_error_m: float | None = ...) -> ObjectComparison: ...
    @property
    def time_ns(self) -> int:
        """Of the image, int, ns."""
    @property
    def true_id(self) -> int | None:
        """int; None: a detection of nothing."""
    @property
    def true_class(self) -> str:
        """str; empty without an object."""
    @property
    def is_wanted(self) -> bool:
        """True: wholly in view with at least 50 px."""
    @property
    def detected_class(self) -> str:
        """str; empty: not detected."""
    @property
    def class_probability(self) -> float:
        """That was said of the class, 0 to 1."""
    @property
    def center_error_px(self) -> float:
        """Of the centre in the image, px."""
    @property
    def depth_error(self) -> float | None:
        """Relative to the distance, or None."""
    @property
    def world_error_m(self) -> float | None:
        """Of the position in the world, m, or None."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class ReportTable:
    """A table of a report, as text."""
    def __init__(self, *, name: str = ..., title: str = ..., note: str = ..., columns: list[str] = ..., rows: list[list[str]] = ...) -> None: ...
    def replace(self, *, name: str = ..., title: str = ..., note: str = ..., columns: list[str] = ..., rows: list[list[str]] = ...) -> ReportTable: ...
    @property
    def name(self) -> str:
        """Name of its file, without the extension."""
    @property
    def title(self) -> str:
        """Title."""
    @property
    def note(self) -> str:
        """A line under the title; may be empty."""
    @property
    def columns(self) -> list[str]:
        """Titles of the columns."""
    @property
    def rows(self) -> list[list[str]]:
        """Lists of cells."""
    @property
    def csv(self) -> str:
        """The table as CSV; unknown values are empty."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class Report:
    """The result of an evaluation."""
    @property
    def title(self) -> str:
        """Title."""
    @property
    def tables(self) -> list[ReportTable]:
        """List of ReportTable."""
    def to_markdown(self) -> str:
        """Returns the tables as a page of Markdown."""
    def write(self, folder: _Path, replace: bool = ...) -> None:
        """Writes report.md, a CSV file for each table and a PNG for each plot (by gnuplot)."""

class LensCalibration:
    """A lens estimated from views of the pattern."""
    @property
    def intrinsics(self) -> CameraIntrinsics:
        """CameraIntrinsics."""
    @property
    def found(self) -> int:
        """Number of views with the pattern, large enough."""
    @property
    def used(self) -> int:
        """Number of views that were used."""
    @property
    def outliers(self) -> int:
        """Number of views that do not fit."""
    @property
    def rms_px(self) -> float:
        """Root mean square of the edges' residuals, px."""
    @property
    def sigmas(self) -> NDArray[np.float64]:
        """Standard deviations of fx, fy / fx, cx, cy and the coefficients, float64 of 9; 0: not estimated."""
    @property
    def warnings(self) -> list[str]:
        """What the views do not determine well, in words."""

class TargetSighting:
    """A detection of the target."""
    def __init__(self, *, time_ns: int = ..., center_in_camera: ArrayLike = ..., sigma_m: float = ...) -> None: ...
    def replace(self, *, time_ns: int = ..., center_in_camera: ArrayLike = ..., sigma_m: float = ...) -> TargetSighting: ...
    @property
    def time_ns(self) -> int:
        """On the clock of the images, int, ns."""
    @property
    def center_in_camera(self) -> NDArray[np.float64]:
        """float64 of 3, m."""
    @property
    def sigma_m(self) -> float:
        """Standard deviation per axis, m."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class MountAndClock:
    """The relation of camera and navigation."""
    def __init__(self, *, body_from_camera: RigidTransform = ..., clock_offset_s: float = ...) -> None: ...
    def replace(self, *, body_from_camera: RigidTransform = ..., clock_offset_s: float = ...) -> MountAndClock: ...
    @property
    def body_from_camera(self) -> RigidTransform:
        """RigidTransform."""
    @property
    def clock_offset_s(self) -> float:
        """t_nav = t_image + clock_offset_s, s."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class FlightCalibration:
    """Mount and clock estimated from a flight."""
    @property
    def estimate(self) -> MountAndClock:
        """MountAndClock."""
    @property
    def angles(self) -> NDArray[np.float64]:
        """Roll, pitch, yaw of the mount relative to the given one, float64 of 3, rad."""
    @property
    def angle_sigmas(self) -> NDArray[np.float64]:
        """Standard deviations, rad."""
    @property
    def clock_sigma_s(self) -> float:
        """Standard deviation, s."""
    @property
    def rms_before_m(self) -> float:
        """Distance of the sightings from the path with the given values, RMS, m."""
    @property
    def rms_after_m(self) -> float:
        """The same with the estimate, m."""
    @property
    def sightings(self) -> int:
        """Number of sightings used."""
    @property
    def outliers(self) -> int:
        """Number of sightings left out."""
    @property
    def warnings(self) -> list[str]:
        """What the flight determines poorly, in words."""
    @property
    def no_use(self) -> str:
        """Why the estimate is not to be used, in words: what the flight does not determine, and what it
        lacks; empty: it may be used. The same for which `kestrel calibrate` writes no file.
        """

class TeamObject:
    """An object of the team's map."""
    def __init__(self, *, object: MappedObject = ..., uavs: list[str] = ..., holder: str = ...) -> None: ...
    def replace(self, *, object: MappedObject = ..., uavs: list[str] = ..., holder: str = ...) -> TeamObject: ...
    @property
    def object(self) -> MappedObject:
        """MappedObject, in this UAV's world."""
    @property
    def uavs(self) -> list[str]:
        """Names of the UAVs that have it in their maps."""
    @property
    def holder(self) -> str:
        """Name of the UAV that goes for it; empty: none."""
    def asdict(self) -> dict[str, Any]:
        """Returns the fields as a dict."""

class TeamMap:
    """The map that a team of UAVs shares, as one UAV holds it. The messages go over any transport:
    they may come late, twice, out of order or not at all. For one thread.
    """
    @property
    def is_whole(self) -> bool:
        """True when all that is known to have been sent is here."""
    def __init__(self, name: str, **kwargs: Any) -> None:
        """name: of this UAV, 1 to 32 letters, digits, '_', '-' and '.'.
        Keyword arguments: options by the names of `kestrel config` under team, as
        rate_bytes_per_s=5000.
        """
    def share(self, objects: list[MappedObject], time_ns: int) -> None:
        """Sets this UAV's own map, a list of MappedObject, at its time; the next tick sends it."""
    def hear(self, message: bytes, now_ns: int) -> None:
        """Takes a message (bytes) of anyone; a malformed one changes nothing.

        now_ns: the time of this computer, which never goes back.
        """
    def tick(self, now_ns: int) -> list[bytes]:
        """Returns the messages that are due, a list of bytes for all others. Call it often, some ten times
        a second.
        """
    def objects(self, now_ns: int) -> list[TeamObject]:
        """Returns the team's map in this UAV's own world, a list of TeamObject."""
    def uavs(self, now_ns: int) -> list[str]:
        """Returns the names of the UAVs that are alive, this one included."""

def read_calibration(file: _Path, camera: str = ...) -> CameraCalibration:
    """Reads the calibration of a camera: files of Kalibr, EuRoC, ROS, OpenCV (YAML, XML), camodocal,
    VINS and ORB-SLAM. Returns a CameraCalibration.

    camera: which one of several in a file of Kalibr ('cam1').
    Warns of keys that are not used. Raises InputError that names file, line and key.
    """
def paper_calibration() -> CameraCalibration:
    """Returns the calibration of the paper's fisheye camera, 752 x 480 px and 185 degrees, which looks
    down from the UAV: for trials.
    """
def hunt_calibration() -> CameraCalibration:
    """Returns the calibration of the simulated colour camera, 1280 x 720 px: for trials."""
def tag_families() -> list[str]:
    """Returns the names of all families of detect_tags."""
def detect_tags(image: NDArray[np.uint8], families: list[str]) -> list[TagDetection]:
    """Finds all AprilTags and ArUco markers in an image, without a calibration.

    image: uint8 of shape (rows, columns) or (rows, columns, 3), BGR, of any size; its pixels are
    not copied.
    families: list of names, as ['tag36h11', 'aruco_4x4_50'] (tag_families).
    Returns a list of TagDetection, by family and id. Raises TypeError for another kind of array,
    InputError for an unknown family. Lets other threads run.
    """
def make_detector(camera: CameraModel | CameraIntrinsics | CameraCalibration, options: _Options = ..., **kwargs: Any) -> TargetDetector:
    """Returns the TargetDetector of a configuration.

    options: a dict by the names of `kestrel config` under landing, or the path of such a file;
    keyword arguments are options, too, as target={'kind': 'apriltag', 'apriltag': {'id': 3,
    'size_m': 0.5}}.
    """
def target_kinds() -> list[str]:
    """Returns the kinds of pads, for target.kind."""
def save_objects(path: str, objects: list[MappedObject]) -> None:
    """Writes a list of MappedObject as JSON, without loss."""
def load_objects(path: str) -> list[MappedObject]:
    """Reads them. Raises InputError with the line."""
def class_of(object: MappedObject, model: ObjectModel) -> str | None:
    """Returns the name of the likeliest class of a MappedObject, or None."""
def geojson(objects: list[MappedObject], model: ObjectModel, latitude_deg: float, longitude_deg: float) -> str:
    """Returns the objects as GeoJSON text; the origin of the world is at this latitude and longitude
    (WGS 84, degrees).
    """
def open_recording(source: _Path | Sequence[_Path] | Recording, camera: _Path | None = ..., format: PixelFormat | str = ...) -> Recording:
    """Opens a recording (EuRoC), a bag, a video, a folder of images or image files.

    source: a path, or a list of images.
    camera: path of the calibration; None: the source's own.
    format: 'gray' or 'bgr'.
    Returns a Recording. Raises InputError that says what is wrong.
    """
def read_images(source: _Path | Sequence[_Path] | Recording, format: PixelFormat | str = ...) -> FrameIterator:
    """Returns an iterator over the Frames of a source, without a calibration."""
def read_image(path: _Path, format: PixelFormat | str = ...) -> NDArray[np.uint8]:
    """Returns the pixels of an image file, uint8: gray (rows, columns), or BGR with format='bgr'."""
def simulate(scenario: str = ..., hunt: bool = ..., camera: CameraCalibration | None = ..., seed: int = ..., **kwargs: Any) -> SimulatedFlight:
    """Plans a SimulatedFlight over the landing pattern, or over coloured objects.

    scenario: one of scenarios().
    camera: CameraCalibration with a mount; None: paper_calibration() or hunt_calibration().
    Keyword arguments: settings as of `kestrel simulate --set`, as frames=100, flight={'altitude_m':
    5}.
    """
def scenarios(hunt: bool = ...) -> dict[str, str]:
    """Returns the names of the simulated flights with their meanings."""
def render_pattern(camera: CameraModel | CameraIntrinsics | CameraCalibration, camera_from_target: RigidTransform, pattern: Mapping[str, Any] = ..., blur_sigma_px: float = ..., noise: float = ..., haze: float = ..., seed: int = ...) -> NDArray[np.uint8]:
    """Returns an image of the landing pattern on level ground, uint8 of the camera's size.

    camera_from_target: RigidTransform; the camera is above the pattern (its z axis is up).
    pattern: dict by the names of landing.detector.pattern.
    blur_sigma_px: of the optics, px. noise: standard deviation, gray values. haze: part of the
    light, 0 to 1.
    Raises InputError for a view from below.
    """
@overload
def draw(image: NDArray[np.uint8], observation: LandingObservation) -> NDArray[np.uint8]: ...
@overload
def draw(image: NDArray[np.uint8], observation: TargetReport) -> NDArray[np.uint8]: ...
@overload
def draw(image: NDArray[np.uint8], observation: HuntObservation) -> NDArray[np.uint8]: ...
@overload
def draw(image: NDArray[np.uint8], observation: FollowObservation) -> NDArray[np.uint8]: ...
@overload
def draw(image: NDArray[np.uint8], observation: ObjectReport) -> NDArray[np.uint8]:
    """Returns a copy of an image with a result drawn in, uint8 BGR: of a pad its outlines, axes,
    distance and quality, or the stage at which the best candidate fell, and why; of objects their
    outlines, classes and distances.

    image: the image that was searched.
    observation: TargetReport, LandingObservation, ObjectReport, HuntObservation or
    FollowObservation.
    """
def evaluate(recording: _Path, output: _Path, hunt: bool = ...) -> Report:
    """Compares the tables that a Session wrote into the folder 'output' with the truth of a recording.
    Returns a Report. Raises InputError when they do not belong together.
    """
def compare_landing(recording: _Path, output: _Path) -> list[LandingComparison]:
    """Holds each row of landing_detections.csv in the folder 'output' against the truth of a
    recording. Returns a list of LandingComparison, one for each row. Raises InputError as evaluate.
    """
def compare_hunt(recording: _Path, output: _Path) -> list[ObjectComparison]:
    """Holds object_detections.csv in the folder 'output' against the truth of a recording. Returns a
    list of ObjectComparison, in order of time. Raises InputError as evaluate.
    """
def calibrate_lens(images: Iterable[NDArray[np.uint8] | Frame], model: DistortionModel | str | None = ..., start: CameraIntrinsics | None = ..., detector: Mapping[str, Any] = ...) -> LensCalibration:
    """Calibrates a lens from images of the landing pattern.

    images: gray images of one size, or Frames.
    model: 'none', 'radial-tangential' or 'equidistant'; None: the one that explains them best.
    start: CameraIntrinsics, a guess.
    detector: dict of landing.detector.
    Returns a LensCalibration. Raises InputError that says what to do where the views do not
    determine the lens. Lets other threads run.
    """
def calibrate_flight(sightings: list[TargetSighting], poses: list[PoseSample], given: MountAndClock, mount: bool = ..., clock: bool = ..., knot_spacing_s: float = ...) -> FlightCalibration:
    """Estimates the angles of the mount and the clock offset with which the target's positions in the
    world fit one path best.

    sightings: list of TargetSighting; poses: list of PoseSample; given: MountAndClock.
    mount, clock: whether each is estimated.
    knot_spacing_s: 0: the target stands; else it moves along a curve with a knot each so many
    seconds.
    Returns a FlightCalibration. Raises InputError for too few sightings with poses.
    """
def calibration_text(calibration: CameraCalibration, rate_hz: float = ...) -> str:
    """Returns the text of a calibration file (EuRoC's sensor.yaml), which read_calibration reads back
    to the last bit.
    """
