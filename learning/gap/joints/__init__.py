"""Systems made of joints, an `axis` or an `arm`: their rigid model, their logs and the search for what is missing."""
