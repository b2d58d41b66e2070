from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0011_site_quota")]

    operations = [
        migrations.AddField("user", "session_generation", models.PositiveIntegerField(default=0)),
        migrations.AddField("signinfailure", "device", models.CharField(max_length=64, default="")),
    ]
