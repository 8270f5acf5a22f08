"""What tests of pages with a view of particles share."""

RING = """
title = "A ring of </script> & spins"
planet.preset = "saturn-a-ring"
box.size = [60.0, 60.0]
particles = { optical_depth = 0.4, density = 450.0, sizes = { law = "power", min = 0.5, max = 2.0, exponent = 3.0 } }
collisions = { restitution = { law = "constant", value = 0.5 }, friction = { tangential_restitution = 0.2 } }
gravity = { solver = "tree", kick_every = 1 }
time = { step = 2e-3, end = 1.0 }
"""


def lit(browser):
    """The fraction of the view's pixels that are not sky, and a number that changes with any of them."""
    return browser.execute_script(
        "const from = document.querySelector('#stage canvas'), to = document.createElement('canvas');"
        "to.width = from.width; to.height = from.height;"
        "const pen = to.getContext('2d'); pen.drawImage(from, 0, 0);"
        "const all = pen.getImageData(0, 0, to.width, to.height).data;"
        "let lit = 0, sum = 0;"
        "for (let k = 0; k < all.length; k += 4) {"
        "  if (all[k] + all[k + 1] + all[k + 2] > 60) ++lit;"
        "  sum = (31 * sum + all[k] + 7 * all[k + 1] + 13 * all[k + 2]) % 1000003; }"
        "return [lit / (all.length / 4), sum];")
