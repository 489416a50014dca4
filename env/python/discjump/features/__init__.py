"""`discjump features`: what leaving a feature of a scene out changes for who plays in it.

    command  the click command and its table
    measure  outcomes of skiers with everything and with each feature left out
    skier    a scripted skier, and how he plays without a feature

Arrows point down only.
"""
