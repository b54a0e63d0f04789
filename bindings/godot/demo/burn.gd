# Pins two corners of the sheet and holds a match to its lower edge.
extends Node3D

func _ready() -> void:
	var sheet: SingeSheet = $Sheet
	if not sheet.start():
		return
	sheet.pin(Vector3(-0.105, 0.105, 0), 0.006)
	sheet.pin(Vector3(0.105, 0.105, 0), 0.006)
	sheet.ignite(Vector3(0.03, -0.105, 0), 0.012, 0.6)
