def draw(files, settings):
    raise NotImplementedError
