"""How the apps' HTTP is put together: the API, refusals, headers, health, the Thing directory's addresses."""
