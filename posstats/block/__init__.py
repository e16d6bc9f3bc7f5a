"""What a survey is: images, cameras, points, frames, and which images are pairs."""
