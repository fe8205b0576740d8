"""The verbs: one public function a file, from one stage of knowledge to the next."""
