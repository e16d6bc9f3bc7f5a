"""Written blocks and orientations read back: blocks of perfect data, and real ones."""

import struct
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from helpers import shared_path
from perfect_block import edit, largest_parallax_mm, perfect_block, written

from posstats.block.camera import Distortion
from posstats.block.frames import GroundFrame
from posstats.block.model import Block
from posstats.contract.notice import listing
from posstats.errors import GeometryError
from posstats.formats.block_folder import read_block, write_block, write_orientations
from posstats.formats.convention import Convention
from posstats.numerics.kernels.rotation import rotation_from_vector, vector_from_rotation

BROWN = Distortion("brown", -0.05, 0.02, -0.003, 4e-4, -3e-4)


def rotation_difference(a: Block, b: Block) -> float:
    """Largest rotation between the images of two blocks in the same frame, rad."""
    turned = (
        np.swapaxes(a.orientations.ground_from_image, -1, -2) @ b.orientations.ground_from_image
    )
    return float(np.abs(vector_from_rotation(turned)).max())


@pytest.mark.parametrize("crs", ["EPSG:32631", "EPSG:2154", "EPSG:32733", None])
@pytest.mark.parametrize("system", ["omega-phi-kappa", "phi-omega-kappa"])
def test_perfect_data_written_in_a_map_grid_comes_back_without_parallax(
    tmp_path, crs, system
) -> None:
    block = perfect_block(crs, system)
    assert largest_parallax_mm(block) < 1e-9
    back = read_block(written(block, tmp_path))
    assert largest_parallax_mm(back) < 1e-6
    assert largest_parallax_mm(replace(back, orientations=back.adjusted)) < 1e-6


@pytest.mark.parametrize("crs", ["EPSG:32631", "EPSG:2154"])
def test_the_same_files_taken_as_cartesian_show_parallax(tmp_path, crs) -> None:
    """What the tangent frame is for: 1:78000 data in a map grid show micrometres."""
    folder = written(perfect_block(crs), tmp_path)
    edit(folder, "block.toml", ('"tangent"', '"grid"'))
    assert largest_parallax_mm(read_block(folder)) > 1e-3


def test_a_written_block_comes_back_whole(tmp_path) -> None:
    block = perfect_block("EPSG:32631", distortion=BROWN)
    sigma = np.linspace(0.02, 0.09, 3 * len(block.orientations)).reshape(-1, 3)
    block = replace(
        block,
        name='quo"te \\ back\nline \x7f <script>',
        simulated=True,
        orientations=replace(
            block.orientations, sigma_position_m=sigma, sigma_angles_rad=sigma / 1e3
        ),
    )
    back = read_block(written(block, tmp_path))
    assert back.name == block.name
    assert back.simulated
    assert back.accuracy == block.accuracy
    camera, camera_back = block.cameras[0], back.cameras[0]
    assert replace(camera_back, id=camera.id) == camera
    assert back.notices == ()
    for name in ("image", "strip", "time_s"):
        expected = getattr(block.orientations, name)
        assert np.array_equal(getattr(back.orientations, name), expected)
    assert np.allclose(back.orientations.sigma_position_m, sigma, rtol=1e-14)
    assert np.allclose(back.orientations.sigma_angles_rad, sigma / 1e3, rtol=1e-12)
    assert np.array_equal(back.tie_points.point_id, block.tie_points.point_id)
    assert np.array_equal(back.tie_points.point, block.tie_points.point)
    assert np.array_equal(back.tie_points.image, block.tie_points.image)
    assert np.allclose(back.tie_points.xy_px, block.tie_points.xy_px, atol=2e-8)
    ground, ground_back = block.ground_points, back.ground_points
    assert np.array_equal(ground_back.point, ground.point)
    assert np.array_equal(ground_back.is_check, ground.is_check)
    assert np.array_equal(ground_back.sigma_xy_m, ground.sigma_xy_m, equal_nan=True)
    again = block.frame.to_computing(back.frame.to_crs(back.orientations.position_m))
    assert np.allclose(again, block.orientations.position_m, atol=1e-6)
    assert [name for name, _ in back.inputs] == [
        "adjusted.csv",
        "block.toml",
        "ground_points.csv",
        "orientations.csv",
        "tie_points.csv",
    ]


def test_several_cameras_and_missing_adjusted_orientations_come_back(tmp_path) -> None:
    block = perfect_block("EPSG:2154")
    other = replace(block.cameras[0], id="b", principal_distance_px=10_000.0, distortion=BROWN)
    first = replace(block.cameras[0], id="a")
    angles = block.adjusted.angles_rad.copy()
    angles[2] = np.nan
    block = replace(
        block,
        cameras=(first, other),
        orientations=replace(block.orientations, camera=np.arange(8) % 2),
        adjusted=replace(block.adjusted, angles_rad=angles),
    )
    back = read_block(written(block, tmp_path))
    assert back.cameras == block.cameras
    assert np.array_equal(back.orientations.camera, np.arange(8) % 2)
    assert np.array_equal(np.isnan(back.adjusted.angles_rad).any(axis=1), np.arange(8) == 2)
    assert back.notices == listing("images_without_adjusted", ["1_002"])
    assert largest_parallax_mm(back) < 1e-6


def test_a_block_replaces_the_one_that_stood_in_the_folder(tmp_path) -> None:
    block = perfect_block(None)
    written(block, tmp_path)
    (tmp_path / "tie_points.parquet").write_bytes(b"old")
    back = read_block(written(replace(block, ground_points=None, adjusted=None), tmp_path))
    assert back.ground_points is None
    assert back.adjusted is None


POS = {
    "plain": "",
    "lever arm": "lever_arm_m = [0.5, -1.0, 1.5]",
    "boresight": "boresight_deg = [0.2, -0.5, 1.0]",
    "both": "lever_arm_m = [0.5, -1.0, 1.5]\nboresight_deg = [0.2, -0.5, 1.0]",
}


def pos_folder(tmp_path, system: str, unit: str, crs: str | None, frame: str, pos: str):
    """A folder whose POS is in the given convention, row order mixed, with an extra column."""
    internal = system if system != "roll-pitch-heading" else "omega-phi-kappa"
    block = perfect_block(crs, internal)
    folder = written(replace(block, adjusted=None), tmp_path)
    columns = ["omega", "phi", "kappa"]
    mounting = ""
    if system == "roll-pitch-heading":
        columns, mounting = ["roll", "pitch", "heading"], "mounting_deg = 90"
    edit(
        folder,
        "block.toml",
        (f'angles = "{internal}"', f'angles = "{system}"'),
        ('angle_unit = "deg"', f'angle_unit = "{unit}"'),
        ("[camera]", f"[pos]\n{POS[pos]}\n{mounting}\n[camera]"),
    )
    if crs is not None:
        edit(folder, "block.toml", ('frame = "tangent"', f'frame = "{frame}"'))
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    rng = np.random.default_rng(8)
    turn = {"deg": 360.0, "rad": 2 * np.pi, "gon": 400.0}[unit]
    angles = rng.normal(0.0, 0.01 * turn, (len(table), 3))
    angles[:, 2] = rng.uniform(-turn / 2, turn / 2, len(table))
    text = [[f"{value:.9f}" for value in row] for row in angles]
    table = table.drop(columns=["omega", "phi", "kappa"])
    table[columns] = text
    table["note"] = [f'"{k}", 0{k}' for k in range(len(table))]
    table.iloc[rng.permutation(len(table))].to_csv(folder / "orientations.csv", index=False)
    return folder


@pytest.mark.parametrize("pos", POS)
@pytest.mark.parametrize(
    ("system", "crs", "frame"),
    [
        (system, crs, frame)
        for system in ("omega-phi-kappa", "phi-omega-kappa", "roll-pitch-heading")
        for crs, frame in (("EPSG:32631", "tangent"), ("EPSG:2154", "grid"), (None, "grid"))
        if crs is not None or system != "roll-pitch-heading"
    ],
)
@pytest.mark.parametrize("unit", ["deg", "rad", "gon"])
def test_corrected_orientations_are_read_as_they_were_meant(
    tmp_path, system, unit, crs, frame, pos
) -> None:
    folder = pos_folder(tmp_path, system, unit, crs, frame, pos)
    block = read_block(folder)
    rng = np.random.default_rng(2)
    error = rng.normal(0.0, 0.01, (len(block.orientations), 3))
    corrected = block.with_angles(block.orientations.angles_rad - error)
    before = pd.read_csv(folder / "orientations.csv", dtype=str, keep_default_na=False)
    write_orientations(block, corrected.orientations.angles_rad, folder / "orientations.csv")
    after = pd.read_csv(folder / "orientations.csv", dtype=str, keep_default_na=False)
    back = read_block(folder)
    assert rotation_difference(back, corrected) < 1e-12
    assert list(after.columns) == list(before.columns)
    kept = [name for name in before.columns if name not in block.source.angle_columns]
    assert after[kept].equals(before[kept])
    turn = {"deg": 180.0, "rad": np.pi, "gon": 200.0}[unit]
    angles = list(block.source.angle_columns)
    assert (after[angles].astype(float) - before[angles].astype(float)).abs().max().max() < turn / 4


def test_uncorrected_orientations_keep_every_character(tmp_path) -> None:
    folder = pos_folder(tmp_path, "roll-pitch-heading", "deg", "EPSG:32631", "tangent", "both")
    block = read_block(folder)
    before = (folder / "orientations.csv").read_bytes()
    write_orientations(block, block.orientations.angles_rad, folder / "orientations.csv")
    assert (folder / "orientations.csv").read_bytes() == before


def test_orientations_of_a_block_in_memory_are_written_like_its_folder(tmp_path) -> None:
    block = perfect_block("EPSG:32631")
    folder = written(block, tmp_path / "block")
    write_orientations(block, block.orientations.angles_rad, tmp_path / "orientations.csv")
    assert (tmp_path / "orientations.csv").read_text() == (folder / "orientations.csv").read_text()


def test_angles_that_are_missing_are_not_written(tmp_path) -> None:
    block = perfect_block(None)
    angles = block.orientations.angles_rad.copy()
    angles[3, 1] = np.nan
    with pytest.raises(GeometryError, match="1_003"):
        write_orientations(block, angles, tmp_path / "orientations.csv")


@pytest.mark.parametrize("name", ["ign-fd1305", "seneca"])
def test_real_orientations_come_back(tmp_path, name) -> None:
    block = read_block(shared_path("data", name))
    source = shared_path("data", name, "orientations.csv")
    write_orientations(block, block.orientations.angles_rad, tmp_path / "o.csv")
    assert pd.read_csv(tmp_path / "o.csv", dtype=str).equals(pd.read_csv(source, dtype=str))


def test_lever_arm_and_boresight_are_those_of_the_imu() -> None:
    """Oracle: R_IMU = R R_B and X = X_S + R lever, composed here from small rotations."""
    true = rotation_from_vector([[0.01, -0.02, 0.8]])
    pitch, roll, yaw = 0.003, -0.002, 0.005
    boresight = (
        rotation_from_vector([pitch, 0, 0])
        @ rotation_from_vector([0, roll, 0])
        @ rotation_from_vector([0, 0, yaw])
    )
    lever = np.array([0.4, -0.7, 1.2])
    convention = Convention(
        "omega-phi-kappa", 1.0, GroundFrame(), 0.0, (roll, pitch, yaw), (0.4, -0.7, 1.2)
    )
    plain = Convention("omega-phi-kappa", 1.0, GroundFrame())
    centre = np.array([[100.0, 200.0, 300.0]])
    antenna = centre + true @ lever
    imu_angles = plain.file_angles(antenna, true @ boresight)
    rotation = convention.ground_from_image(antenna, imu_angles)
    assert np.allclose(rotation, true, atol=1e-15)
    assert np.allclose(convention.projection_centre(antenna, rotation), centre, atol=1e-12)
    assert np.allclose(convention.file_angles(antenna, rotation), imu_angles, atol=1e-15)


def test_sigmas_of_navigation_angles_are_propagated() -> None:
    """Oracle: scatter of the converted angles of simulated roll, pitch, heading."""
    convention = Convention("roll-pitch-heading", 1.0, GroundFrame("EPSG:32631"))
    angles = np.array([[0.3, -0.2, 1.1]])
    sigma = np.array([[2e-4, 5e-4, 3e-3]])
    rng = np.random.default_rng(6)
    n = 200_000
    noisy = angles + sigma * rng.normal(size=(n, 3))
    position = np.tile([500_000.0, 5e6, 0.0], (n, 1))
    scatter = convention.computing_angles(convention.ground_from_image(position, noisy)).std(axis=0)
    assert np.allclose(convention.sigma_angles_rad(sigma, angles)[0], scatter, rtol=0.01)


def test_orthometric_blocks_are_written_with_their_geoid(tmp_path) -> None:
    grid = tmp_path / "geoid.gtx"
    header = struct.pack(">4d2i", 40.0, 0.0, 4.0, 4.0, 5, 5)
    grid.write_bytes(header + (45.0 + 0.5 * np.arange(25.0)).astype(">f4").tobytes())
    block = perfect_block("EPSG:32631")
    frame = GroundFrame.tangent("EPSG:32631", [(700_000.0, 5_500_000.0, 0.0)], grid)
    folder = written(replace(block, frame=frame), tmp_path / "block")
    back = read_block(folder)
    assert "geoid.gtx" in dict(back.inputs) or str(grid) in dict(back.inputs)
    assert largest_parallax_mm(back) < 1e-6
    heights = pd.read_csv(folder / "orientations.csv").z
    undulation = frame.to_crs(block.orientations.position_m)[:, 2]
    assert np.allclose(heights, undulation)
    write_block(block, tmp_path / "ellipsoidal")
    difference = pd.read_csv(tmp_path / "ellipsoidal" / "orientations.csv").z - heights
    assert ((difference > 44.0) & (difference < 58.0)).all()
